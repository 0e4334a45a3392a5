// Run: one source through the workers. The page gets the map and the frames as they are done, then the results.
"use strict";

let engine_compiled = null;

/// The compiled system, once for all workers.
async function compile_engine() {
  const packed = await fetch(`data:application/gzip;base64,${by_id("engine-bytes").textContent.trim()}`);
  const bytes = new Response(packed.body.pipeThrough(new DecompressionStream("gzip")));
  return WebAssembly.compile(await bytes.arrayBuffer());
}

function start_worker(...parts) {
  const code = ["engine", "worker-module", ...parts].map((id) => by_id(id).textContent).join("\n");
  const url = URL.createObjectURL(new Blob([code], { type: "text/javascript" })), worker = new Worker(url);
  URL.revokeObjectURL(url);
  return worker;
}

class Run {
  /// `on`: { opened(sequence), map, kept, calibrating, frame, finishing, finished, error(message) }. `network`: the files of
  /// detector.js, where they detect and read the texts; else the built-in detector does.
  constructor(on, network) {
    this.on = on;
    this.over = false;
    this.detector = network ? { detector_name: "PP-OCRv4", reads: true } : { detector_name: "classical", reads: false };
    this.mapper = start_worker("worker-mapper");
    this.eyes = start_worker("worker-pictures", "worker-images", "worker-mp4", "worker-mp4-fragments", "worker-webm", "worker-video",
      "worker-eyes");
    this.network = network ? start_worker("worker-network") : null;
    const frames = new MessageChannel(), detections = new MessageChannel();
    this.mapper.postMessage({ type: "ports", frames: frames.port1, detections: detections.port1 }, [frames.port1, detections.port1]);
    const own = network ? [] : [detections.port2];
    this.eyes.postMessage({ type: "mapper", port: frames.port2, detections: own[0] }, [frames.port2, ...own]);
    if (network) this.network.postMessage({ port: detections.port2, parts: network }, [detections.port2]);
    engine_compiled = engine_compiled || compile_engine();
    engine_compiled.catch((error) => this.fail(error.message));
    for (const worker of this.workers()) {
      engine_compiled.then((compiled) => worker.postMessage({ type: "engine", compiled }), () => {});
      worker.onmessage = ({ data }) => this.take(data);
      worker.onerror = (event) => this.fail(event.message);
    }
  }

  workers() { return [this.mapper, this.eyes, this.network].filter(Boolean); }

  take(message) {
    if (this.over) return;
    if (message.type === "seen") this.camera_is_free = true;
    else if (message.type === "error") this.fail(message.message);
    else this.on[message.type](message);
    if (message.type === "finished") this.end();
  }

  fail(message) {
    if (this.over || this.failed) return;  // what follows from the first failure says less
    this.on.error(message || "a worker of this page failed");
    this.failed = true;
  }

  /// What the module says of a sequence: see PageRun::sequence(). The settings go to the mapper.
  async open(files, settings, live) {
    this.mapper.postMessage({ type: "open", ...files, map: settings.map });
    const sequence = await new Promise((done) => { this.on.opened = (message) => done(message.sequence); });
    const { map, calibrate, ...others } = settings;
    this.mapper.postMessage({ type: "begin", ...others, ...this.detector, calibrate: calibrate && !sequence.known_camera && !live, live });
    return sequence;
  }

  /// The files of a sequence, see sequence_of().
  async open_files(sequence, settings) {
    const video = sequence.video ? sequence.video.name : "";
    const { frames, most_side: side } = await this.open({ folder: sequence.folder, video, files: sequence.texts }, settings, false);
    const named = frames.map(({ path, time }) => {
      const name = path.slice(path.indexOf("/", 1) + 1);
      const file = sequence.by_path.get(name) || sequence.by_path.get(name.split("/").pop());  // chosen without its folder
      return { name, time, file };
    });
    const source = sequence.video ? { kind: "video", file: sequence.video, side } : { kind: "images", frames: named, side };
    this.eyes.postMessage({ type: "read", source });
    this.stop = () => this.eyes.postMessage({ type: "halt" });
    return named.length;
  }

  async open_camera(settings) {
    this.webcam = await Webcam.open();
    const { most_side: side } = await this.open({ folder: "camera", video: "live", files: [] }, settings, true);
    this.camera_is_free = true;
    this.stop = () => {
      this.webcam.stop();
      this.eyes.postMessage({ type: "stop" });
    };
    const readable = this.webcam.stream_of_frames();
    if (readable) return this.eyes.postMessage({ type: "stream", readable, side }, [readable]);
    await this.webcam.start(() => this.camera_is_free, (frame, time) => {
      this.camera_is_free = false;
      this.eyes.postMessage({ type: "camera", frame, time, side }, [frame]);
    });
  }

  end() {
    this.over = true;
    if (this.webcam) this.webcam.stop();
    for (const worker of this.workers()) worker.terminate();
  }
}
