// Scene: the map as buffers of WebGL 2. Layers of lines and points, and the texts as textured quads.
"use strict";

const SHADERS = {
  plain: [`#version 300 es
    in vec3 position; in float shade; uniform mat4 clip; uniform float size; flat out float grey;
    void main() { gl_Position = clip * vec4(position, 1.0); gl_PointSize = size; grey = shade; }`,
  `#version 300 es
    precision mediump float; flat in float grey; out vec4 result;
    uniform vec3 colour; uniform vec2 greys; uniform float alpha; uniform bool round;
    void main() {
      if (round && length(gl_PointCoord - 0.5) > 0.5) discard;
      result = vec4(grey < 0.0 ? colour : vec3(mix(greys.x, greys.y, grey)), 1.0) * alpha;
    }`],
  textured: [`#version 300 es
    in vec3 position; in vec2 at; uniform mat4 clip; out vec2 uv;
    void main() { gl_Position = clip * vec4(position, 1.0); uv = at; }`,
  `#version 300 es
    precision mediump float; uniform sampler2D image; in vec2 uv; out vec4 result;
    void main() { result = vec4(texture(image, uv).rgb, 1.0); }`],
};
const QUAD_CELLS = 6;  // a side: the picture is bilinear in the corners, a pair of triangles is not

/// Vertices of one colour, or each of its grey value. Each part of a layer is there from a frame on.
class Layer {
  constructor(gl, properties) {
    Object.assign(this, properties, { gl, visible: true, count: 0, begins: [], ends: [] });
    this.array = gl.createVertexArray();
    this.buffer = gl.createBuffer();
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    for (const [at, size, offset] of [[0, 3, 0], [2, 1, 12]]) {
      gl.enableVertexAttribArray(at);
      gl.vertexAttribPointer(at, size, gl.FLOAT, false, 16, offset);
    }
  }

  /// parts: [{frame, numbers: [x, y, z, ...], grey: 0 to 1, or none for the colour of the layer}].
  set_parts(parts) {
    const vertices = [];
    this.begins = [];
    this.ends = [];
    for (const { frame, numbers, grey = -1 } of [...parts].sort((a, b) => a.frame - b.frame)) {
      for (let i = 0; i < numbers.length; i += 3) vertices.push(numbers[i], numbers[i + 1], numbers[i + 2], grey);
      this.begins.push(frame);
      this.ends.push(vertices.length / 4);
    }
    this.gl.bindBuffer(this.gl.ARRAY_BUFFER, this.buffer);
    this.gl.bufferData(this.gl.ARRAY_BUFFER, new Float32Array(vertices), this.gl.DYNAMIC_DRAW);
    this.until(Infinity);
  }

  /// What is always there.
  set(numbers) { this.set_parts([{ frame: -Infinity, numbers }]); }

  /// Shows what is there at frame `frame`.
  until(frame) {
    const later = this.begins.findIndex((begin) => begin > frame), parts = later < 0 ? this.ends.length : later;
    this.count = parts ? this.ends[parts - 1] : 0;
  }

  get empty() { return !this.ends.length || !this.ends[this.ends.length - 1]; }
}

class Scene {
  /// Throws where there is no WebGL 2.
  constructor(canvas) {
    const gl = canvas.getContext("webgl2", { antialias: true });
    if (!gl) throw new Error("no WebGL 2");
    this.gl = gl;
    this.programs = {};
    for (const name of Object.keys(SHADERS)) this.programs[name] = this.program(...SHADERS[name]);
    this.layers = [];
    this.quads = [];
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
  }

  program(vertex, fragment) {
    const gl = this.gl, program = gl.createProgram();
    for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.bindAttribLocation(program, 0, "position");
    gl.bindAttribLocation(program, 1, "at");
    gl.bindAttribLocation(program, 2, "shade");
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    const place = (name) => gl.getUniformLocation(program, name);
    const out = { program };
    for (const name of ["clip", "size", "colour", "round", "greys", "alpha"]) out[name] = place(name);
    return out;
  }

  /// A layer of lines (pairs of vertices) or of points of so many px; `colour` is a CSS variable.
  add_layer(name, colour, points = 0, alpha = 1) {
    this.layers.push(new Layer(this.gl, { name, colour, points, alpha }));
    return this.layers[this.layers.length - 1];
  }

  /// The texts as quads with their pictures; `ready` is called when another can be drawn. A picture that a text had
  /// before stays on its quad.
  set_quads(texts, ready) {
    const before = new Map(this.quads.map((quad) => [quad.id, quad]));
    this.quads = texts.map(({ id, corners, image }) => {
      const quad = before.get(id) || this.make_quad(id);
      before.delete(id);
      this.place(quad, corners);
      if (image && image !== quad.image) this.paint(quad, image, ready);
      return quad;
    });
    for (const quad of before.values()) {
      this.gl.deleteVertexArray(quad.array);
      this.gl.deleteBuffer(quad.buffer);
      this.gl.deleteTexture(quad.texture);
    }
  }

  /// Grey, without a place.
  make_quad(id) {
    const gl = this.gl, quad = { id, array: gl.createVertexArray(), buffer: gl.createBuffer(), texture: gl.createTexture() };
    gl.bindVertexArray(quad.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, quad.buffer);
    for (const [at, size, offset] of [[0, 3, 0], [1, 2, 12]]) {
      gl.enableVertexAttribArray(at);
      gl.vertexAttribPointer(at, size, gl.FLOAT, false, 20, offset);
    }
    this.put(quad, 1, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array([128, 128, 128, 255]));
    return quad;
  }

  place(quad, corners) {
    const gl = this.gl, vertices = [];
    const vertex = (i, j) => {
      const u = i / QUAD_CELLS, v = j / QUAD_CELLS;
      vertices.push(...mix(mix(corners[0], corners[1], u), mix(corners[3], corners[2], u), v), u, v);
    };
    for (let j = 0; j < QUAD_CELLS; ++j)
      for (let i = 0; i < QUAD_CELLS; ++i)
        for (const [a, b] of [[0, 0], [1, 0], [1, 1], [0, 0], [1, 1], [0, 1]]) vertex(i + a, j + b);
    quad.count = vertices.length / 5;
    gl.bindBuffer(gl.ARRAY_BUFFER, quad.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(vertices), gl.DYNAMIC_DRAW);
  }

  paint(quad, picture, ready) {
    const gl = this.gl, image = new Image();
    quad.image = picture;
    image.onload = () => {
      if (quad.image !== picture || !this.quads.includes(quad)) return;
      this.put(quad, gl.RGBA, gl.UNSIGNED_BYTE, image);
      ready();
    };
    image.src = picture;
  }

  put(quad, ...source) {
    const gl = this.gl;
    gl.bindTexture(gl.TEXTURE_2D, quad.texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, ...source);
    gl.generateMipmap(gl.TEXTURE_2D);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
  }

  draw(clip, with_quads) {
    const gl = this.gl, [r, g, b] = rgb(css("--view"));
    gl.viewport(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight);
    gl.clearColor(r, g, b, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    if (with_quads) {
      gl.useProgram(this.programs.textured.program);
      gl.uniformMatrix4fv(this.programs.textured.clip, false, clip);
      for (const quad of this.quads) {
        if (quad.hidden) continue;
        gl.bindVertexArray(quad.array);
        gl.bindTexture(gl.TEXTURE_2D, quad.texture);
        gl.drawArrays(gl.TRIANGLES, 0, quad.count);
      }
    }
    const plain = this.programs.plain, ratio = window.devicePixelRatio || 1;
    gl.useProgram(plain.program);
    gl.uniformMatrix4fv(plain.clip, false, clip);
    // Not the whole range: a point must not have the colour of what is behind it.
    gl.uniform2f(plain.greys, Number(css("--grey-low")), Number(css("--grey-high")));
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    for (const layer of this.layers) {
      if (!layer.visible || !layer.count) continue;
      gl.bindVertexArray(layer.array);
      gl.uniform3fv(plain.colour, rgb(css(layer.colour)));
      gl.uniform1f(plain.alpha, layer.alpha);
      gl.uniform1f(plain.size, layer.points * ratio);
      gl.uniform1i(plain.round, layer.points ? 1 : 0);
      gl.depthMask(layer.alpha === 1);
      gl.drawArrays(layer.points ? gl.POINTS : gl.LINES, 0, layer.count);
    }
    gl.depthMask(true);
    gl.disable(gl.BLEND);
  }
}
