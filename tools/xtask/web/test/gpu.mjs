// Counts GPU objects and memory of a page at their creation, because browsers do not report them.

/** Runs in the page before it starts: counts live objects for `gpu()`. */
export function countGpu() {
  /** Live objects, with the bytes requested for each. @type {Map<object, number>} */
  const living = new Map();
  const context = WebGL2RenderingContext.prototype;
  const GL = WebGL2RenderingContext;
  /** Wraps a function so that `told` gets its arguments and result. */
  const beside = (/** @type {string} */ name, /** @type {(gl: any, words: any[], answer: any) => void} */ told) => {
    const inner = context[name];
    context[name] = function (...words) {
      const answer = inner.apply(this, words);
      told(this, words, answer);
      return answer;
    };
  };

  for (const kind of ["Buffer", "Texture", "Renderbuffer", "Framebuffer", "Program", "Shader", "Sampler", "VertexArray", "Query"]) {
    beside(`create${kind}`, (gl, words, made) => made && living.set(made, 0));
    beside(`delete${kind}`, (gl, [gone]) => living.delete(gone));
  }
  beside("fenceSync", (gl, words, made) => made && living.set(made, 0));
  beside("deleteSync", (gl, [gone]) => living.delete(gone));

  const BUFFERS = {
    [GL.ARRAY_BUFFER]: GL.ARRAY_BUFFER_BINDING,
    [GL.ELEMENT_ARRAY_BUFFER]: GL.ELEMENT_ARRAY_BUFFER_BINDING,
    [GL.UNIFORM_BUFFER]: GL.UNIFORM_BUFFER_BINDING,
    [GL.COPY_READ_BUFFER]: GL.COPY_READ_BUFFER_BINDING,
    [GL.COPY_WRITE_BUFFER]: GL.COPY_WRITE_BUFFER_BINDING,
    [GL.PIXEL_PACK_BUFFER]: GL.PIXEL_PACK_BUFFER_BINDING,
    [GL.PIXEL_UNPACK_BUFFER]: GL.PIXEL_UNPACK_BUFFER_BINDING,
    [GL.TRANSFORM_FEEDBACK_BUFFER]: GL.TRANSFORM_FEEDBACK_BUFFER_BINDING,
  };
  const TEXTURES = {
    [GL.TEXTURE_2D]: GL.TEXTURE_BINDING_2D,
    [GL.TEXTURE_2D_ARRAY]: GL.TEXTURE_BINDING_2D_ARRAY,
    [GL.TEXTURE_3D]: GL.TEXTURE_BINDING_3D,
    [GL.TEXTURE_CUBE_MAP]: GL.TEXTURE_BINDING_CUBE_MAP,
  };
  /** Bytes per pixel of formats that do not have four. */
  const PIXELS = { [GL.R8]: 1, [GL.RG8]: 2, [GL.DEPTH_COMPONENT16]: 2, [GL.R16F]: 2, [GL.RGBA16F]: 8, [GL.RGBA32F]: 16, [GL.RG32F]: 8 };
  const pixel = (/** @type {number} */ format) => PIXELS[format] ?? 4;
  const keep = (gl, /** @type {number} */ binding, /** @type {number} */ bytes) => living.set(gl.getParameter(binding), bytes);
  const lengths = (/** @type {number[]} */ levels) => levels.reduce((sum, level) => sum + level, 0);

  beside("bufferData", (gl, [target, data, , , length]) => {
    const bytes = typeof data === "number" ? data : length ? length * (data.BYTES_PER_ELEMENT ?? 1) : data.byteLength;
    keep(gl, BUFFERS[target], bytes);
  });
  const storage = (gl, [target, levels, format, width, height, depth = 1]) => {
    const sizes = Array.from({ length: levels }, (_, level) => (width >> level || 1) * (height >> level || 1) * depth * pixel(format));
    keep(gl, TEXTURES[target], lengths(sizes));
  };
  beside("texStorage2D", storage);
  beside("texStorage3D", storage);
  beside("texImage2D", (gl, [target, level, format, width, height]) => {
    if (level === 0 && typeof height === "number") keep(gl, TEXTURES[target], width * height * pixel(format));
  });
  beside("renderbufferStorage", (gl, [, format, width, height]) => keep(gl, GL.RENDERBUFFER_BINDING, width * height * pixel(format)));
  beside("renderbufferStorageMultisample", (gl, [, samples, format, width, height]) =>
    keep(gl, GL.RENDERBUFFER_BINDING, Math.max(samples, 1) * width * height * pixel(format)),
  );

  globalThis.gpu = () => ({ objects: living.size, bytes: lengths([...living.values()]) });
}
