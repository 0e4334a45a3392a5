// Run: one source through the workers. The page gets the map and the frames as they are done, then the results.
"use strict";

const MOST_SIDE = 960;  // px, of frames without a camera file: larger ones are made smaller

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
    this.detector_name = network ? "PP-OCRv4" : "classical";
    this.mapper = start_worker("worker-mapper");
    this.eyes = start_worker("worker-pictures", "worker-images", "worker-mp4", "worker-mp4-fragments", "worker-webm", "worker-video",
      "worker-eyes");
    this.network = network ? start_worker("worker-network") : null;
    const frames = new MessageChannel(), detections = new MessageChannel();
    this.mapper.postMessage({ type: "ports", frames: frames.port1, detections: detections.port1 }, [frames.port1, detections.port1]);
    const own = network ? [] : [detections.port2];
    this.eyes.postMessage({ type: "mapper", port: frames.port2, detections: own[0] }, [frames.port2, ...own]);
    if (network) this.network.postMessage({ port: detections.port2, parts: network }, [detections.port2]);
    for (const worker of this.workers()) {
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

  settings(of_page) { return { ...of_page, detector_name: this.detector_name }; }

  /// The files of a sequence, see sequence_of().
  async open_files(sequence, settings) {
    this.mapper.postMessage({ type: "open", folder: sequence.folder, video: sequence.video ? sequence.video.name : "", files: sequence.texts });
    const { frames, camera } = await new Promise((done) => { this.on.opened = (message) => done(message.sequence); });
    this.mapper.postMessage({ type: "begin", ...this.settings(settings), calibrate: settings.calibrate && !camera, live: false });
    const side = camera ? 0 : MOST_SIDE;
    const named = frames.map(({ path, time }) => {
      const name = path.slice(path.indexOf("/", 1) + 1);
      const file = sequence.by_path.get(name) || sequence.by_path.get(name.split("/").pop());  // chosen without its folder
      return { name, time, file };
    });
    const source = sequence.video ? { kind: "video", file: sequence.video, side } : { kind: "images", frames: named, side };
    this.eyes.postMessage({ type: "read", source });
    this.stop = () => this.eyes.postMessage({ type: "halt" });
    return { frames: named.length, camera };
  }

  async open_camera(settings) {
    this.webcam = await Webcam.open();
    this.mapper.postMessage({ type: "open", folder: "camera", video: "live", files: [] });
    await new Promise((done) => { this.on.opened = () => done(); });
    this.mapper.postMessage({ type: "begin", ...this.settings(settings), calibrate: false, live: true });
    this.camera_is_free = true;
    this.stop = () => {
      this.webcam.stop();
      this.eyes.postMessage({ type: "stop" });
    };
    await this.webcam.start(() => this.camera_is_free, (frame, time) => {
      this.camera_is_free = false;
      this.eyes.postMessage({ type: "camera", frame, time, side: MOST_SIDE }, [frame]);
    });
  }

  end() {
    this.over = true;
    if (this.webcam) this.webcam.stop();
    for (const worker of this.workers()) worker.terminate();
  }
}
