#!/usr/bin/env python3
"""Writes seeds for the fuzzers: OUTPUT/<fuzzer>/<name>. The same bytes each time.

Numeric fuzzers get byte strings that reach each of their branches; the fuzzer of files gets small whole files of each kind,
led by the byte that says which.
"""
import random
import struct
import sys
import zlib
from pathlib import Path

NUMERIC = {"photometry": (1, 400), "features": (5, 120), "geometry": (4, 300), "solver": (3, 500), "rigs": (3, 700), "texts": (8, 3000), "cameras": (6, 300)}

CAMERA = """%YAML:1.0
Camera.fx: 525.0
Camera.fy: 525.0
Camera.cx: 319.5
Camera.cy: 239.5
Camera.k1: 0.1
Camera.k2: -0.01
Camera.p1: 0.0
Camera.p2: 0.001
Camera.width: 640
Camera.height: 480
Camera.fps: 30.0
"""
SENSOR = """sensor_type: camera
T_BS:
  cols: 4
  rows: 4
  data: [0, -1, 0, 0.1, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
rate_hz: 20
resolution: [752, 480]
camera_model: pinhole
intrinsics: [458.654, 457.296, 367.215, 248.375] # fu, fv, cu, cv
distortion_model: radial-tangential
distortion_coefficients: [-0.28, 0.07, 0.0002, 1.7e-05]
"""
CHAIN = """cam0:
  T_cam_imu:
  - [0, 1, 0, 0.1]
  - [-1, 0, 0, 0]
  - [0, 0, 1, 0]
  - [0, 0, 0, 1]
  camera_model: ds
  intrinsics: [-0.17, 0.59, 158.3, 158.2, 254.9, 256.5]
  distortion_model: none
  distortion_coeffs: []
  resolution: [512, 512]
"""
OPENCV = """%YAML:1.0
---
image_width: 640
image_height: 480
camera_matrix: !!opencv-matrix
   rows: 3
   data: [ 500., 0., 319.5, 0., 5.0e+02, 239.5, 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   data: [ 0.1, -0.2, 0., 0., 0.01 ]
"""
XML = """<?xml version="1.0"?>
<opencv_storage>
<!-- a comment -->
<image_width>640</image_width><image_height>480</image_height>
<camera_matrix type_id="opencv-matrix"><data>500. 0. 319.5 0. 500. 239.5 0. 0. 1.</data></camera_matrix>
<distortion_coefficients><data>0.1 -0.2 0.001 0.</data></distortion_coefficients><fisheye_model>1</fisheye_model>
</opencv_storage>
"""
TEXT_MAP = """{"texts":[{"id":0,"text":"EXIT","corners":[[0,0,1],[1,0,1],[1,1,1],[0,1,1]],"normal":[0,0,-1],
"theta":[0,0,1],"host":0.1,"observations":7,"zncc":0.9}]}"""


def png(width, height):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = b"".join(b"\0" + bytes((x * 7 + y * 11) % 256 for x in range(width)) for y in range(height))
    header = struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def files():
    yield "icdar", 0, b"10,20,60,20,60,40,10,40,EXIT\n1.5,2,3,4,5,6,7,8,0.9,###\n"
    yield "tum", 1, b"# timestamp tx ty tz qx qy qz qw\n0.0 0 0 0 0 0 0 1\n0.033 0.1 0 0 0 0.0998334 0 0.9950042\n"
    yield "camera", 2, CAMERA.encode()
    yield "text_map", 3, TEXT_MAP.encode()
    yield "json", 4, b'{"a":[1,2.5e3,null,true,"\\u00e9"],"b":{}}'
    yield "png", 5, png(9, 6)
    yield "pgm", 5, b"P5\n# comment\n4 3\n255\n" + bytes(range(12))
    yield "ppm", 5, b"P6 2 2 65535\n" + bytes(range(24))
    yield "plain", 5, b"P2\n3 2\n15\n0 1 2 3 4 15\n"
    yield "lines", 6, b"one\r\ntwo\n\n# three\n"
    yield "euroc_camera", 7, SENSOR.encode()
    yield "camchain", 7, CHAIN.encode()
    yield "opencv_yaml", 7, OPENCV.encode()
    yield "opencv_xml", 7, XML.encode()
    yield "colmap", 7, b"# cameras\n1 OPENCV_FISHEYE 640 480 500 500 320 240 0.003 0.001 -0.002 0.0002\n"
    yield "fisheye", 7, CAMERA.replace("p1", "k3").replace("p2", "k4").encode() + b'Camera.type: "KannalaBrandt8"\n'
    yield "euroc_frames", 8, b"#timestamp [ns],filename\r\n1403636579763555584,a.png\r\n1403636579813555456,b.png\r\n"
    yield "euroc_truth", 9, b"#timestamp,x,y,z,w,x,y,z,v\n1403636579763555584,4.6,-1.7,0.8,0.6,0.0,-0.8,0.0,1\n"
    yield "icdar_line", 10, b"\xef\xbb\xbf1.5,2,3,4,5,6,7,8,0.9,A, \"B\"\r\n"


def write(folder, name, data):
    folder.mkdir(parents=True, exist_ok=True)
    (folder / name).write_bytes(data)


def main(output):
    draw = random.Random(1)
    for fuzzer, (branches, length) in NUMERIC.items():
        for branch in range(branches):
            for variant in range(6):
                # Selector bytes below 240 give tame numbers; the last two variants hold any bytes.
                top = 239 if variant < 4 else 255
                tail = bytes(draw.randrange(top + 1) for _ in range(length))
                head = struct.pack("<H", branch) if branches > 1 else b""
                write(output / fuzzer, f"{branch}-{variant}", head + tail)
    for name, kind, data in files():
        write(output / "files", name, bytes([kind]) + data)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: make_corpus.py OUTPUT")
    main(Path(sys.argv[1]))
