// The camera of the computer or phone: frames as they come, while the system keeps up.
"use strict";

class Webcam {
  /// Asks for it. Throws an Error that says why there is none.
  static async open() {
    if (!navigator.mediaDevices) throw new Error("This browser gives pages from a file no camera.");
    const wanted = { width: { ideal: 640 }, height: { ideal: 480 }, frameRate: { ideal: 30 }, facingMode: "environment" };
    try {
      return new Webcam(await navigator.mediaDevices.getUserMedia({ video: wanted }));
    } catch (error) {
      throw new Error(error.name === "NotAllowedError" ? "The camera was not allowed." : `There is no camera: ${error.message}`);
    }
  }

  constructor(stream) {
    this.stream = stream;
    this.missed = 0;
    this.video = document.createElement("video");
    Object.assign(this.video, { muted: true, playsInline: true, srcObject: stream });
  }

  /// The frames as they come, as the camera has them, to be read by a worker; null where the browser has no such stream. By
  /// way of a video they are drawn first, and on the page's own thread.
  stream_of_frames() {
    if (!self.MediaStreamTrackProcessor) return null;
    return new MediaStreamTrackProcessor({ track: this.stream.getVideoTracks()[0], maxBufferSize: 1 }).readable;
  }

  /// `take(frame, time)` gets each frame, a VideoFrame or an ImageBitmap that it owns, when `free()` is true.
  start(free, take) {
    const next = () => {
      if (!this.stream) return;
      if (this.video.requestVideoFrameCallback) this.video.requestVideoFrameCallback(show);
      else setTimeout(() => show(performance.now(), {}), 33);
    };
    const show = async (now, data) => {
      next();
      if (!free()) return void ++this.missed;
      const time = (data.captureTime || now) / 1000;
      try {
        take(self.VideoFrame ? new VideoFrame(this.video, { timestamp: Math.round(1e6 * time) }) : await createImageBitmap(this.video), time);
      } catch (error) {
        ++this.missed;  // a video that has no picture yet
      }
    };
    next();
    return this.video.play();
  }

  stop() {
    if (!this.stream) return;
    for (const track of this.stream.getTracks()) track.stop();
    this.stream = null;
    this.video.srcObject = null;
  }
}
