// Unpacks what gzip packed. Some servers and browsers have unpacked such a file already, so that its first bytes decide.

const MAGIC = [0x1f, 0x8b];

// The bytes of a blob, unpacked if they are packed.
export async function unpacked(blob) {
  const start = new Uint8Array(await blob.slice(0, 2).arrayBuffer());
  const packed = MAGIC.every((byte, i) => start[i] === byte);
  const source = packed ? new Response(blob.stream().pipeThrough(new DecompressionStream("gzip"))) : blob;
  return new Uint8Array(await source.arrayBuffer());
}
