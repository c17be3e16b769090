"use strict";
/* Numbers from text: base64, inflate, join the byte planes, add up the differences. NaN is code
   -32768. A series holds one component over time: at(s, frame) = values[s * frames + frame]. */
async function unpack(packed) {
  const raw = Uint8Array.from(atob(packed.data), (c) => c.charCodeAt(0));
  const inflated = new Blob([raw]).stream().pipeThrough(new DecompressionStream("deflate"));
  const bytes = new Uint8Array(await new Response(inflated).arrayBuffer());
  const count = bytes.length / 2;
  const frames = packed.shape[0];
  const values = new Float32Array(count);
  for (let start = 0; start < count; start += frames) {
    let code = 0;
    for (let i = start; i < start + frames; i++) {
      code = (code + bytes[i] + (bytes[count + i] << 8)) & 0xffff;
      const signed = code > 32767 ? code - 65536 : code;
      values[i] = signed === -32768 ? NaN : packed.offset + packed.step * signed;
    }
  }
  return { values, frames, at: (s, frame) => values[s * frames + frame] };
}
