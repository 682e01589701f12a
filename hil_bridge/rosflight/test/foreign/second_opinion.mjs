// Frames of MAVLink 1 as another library reads and writes them, as JSON.
//
//   node second_opinion.mjs read FRAMES                  what is in the file
//   node second_opinion.mjs write FRAMES EACH ID...      puts EACH frames of every message into the file, and says what it put there

import { readFileSync, writeFileSync } from "node:fs";
import { Readable } from "node:stream";
import { common, MavLinkPacketParser, MavLinkPacketSplitter, MavLinkProtocolV1, minimal, x25crc } from "node-mavlink";

const registry = { ...minimal.REGISTRY, ...common.REGISTRY };
const plain = (value) => (typeof value === "bigint" ? value.toString() : value);

function described(header, kind, message) {
  const fields = Object.fromEntries(kind.FIELDS.filter((field) => !field.extension).map((field) => [field.name, plain(message[field.name])]));
  return { id: header.msgid, sequence: header.seq, system: header.sysid, component: header.compid, fields };
}

async function read(file) {
  const packets = Readable.from([readFileSync(file)], { objectMode: false }).pipe(new MavLinkPacketSplitter()).pipe(new MavLinkPacketParser());
  const found = [];
  for await (const packet of packets) {
    const kind = registry[packet.header.msgid];
    found.push(described(packet.header, kind, packet.protocol.data(packet.payload, kind)));
  }
  return found;
}

/** xorshift32 */
let state = 20261122;
function random() {
  state ^= state << 13;
  state ^= state >>> 17;
  state ^= state << 5;
  return state >>> 0;
}

function anyValue(field) {
  const views = new DataView(new ArrayBuffer(8));
  views.setUint32(0, random());
  views.setUint32(4, random());
  const type = field.type.replace("_mavlink_version", "");
  if (type === "char[]") return Array.from({ length: random() % (field.length + 1) }, () => String.fromCharCode(33 + (random() % 94))).join("");
  if (type === "float") return Number.isFinite(views.getFloat32(0)) ? views.getFloat32(0) : 0;
  if (type === "int64_t") return views.getBigInt64(0);
  const [, sign, bits] = /^(u?)int(8|16|32)_t$/.exec(type);
  return views[`get${sign ? "Uint" : "Int"}${bits}`](0);
}

/**
 * MAVLink 1 knows no extension fields. The library sends them nevertheless, as zeros behind the payload: they are cut off,
 * and the frame is sealed with the library's own checksum.
 */
function withoutExtensions(kind, frame) {
  const length = Math.max(...kind.FIELDS.filter((field) => !field.extension).map((field) => field.offset + field.size * (field.length || 1)));
  const short = Buffer.concat([frame.subarray(0, 6 + length), Buffer.alloc(2)]);
  short.writeUInt8(length, 1);
  short.writeUInt16LE(x25crc(short, 1, 2, kind.MAGIC_NUMBER), short.length - 2);
  return short;
}

function write(file, each, ids) {
  const frames = [];
  const written = [];
  for (const id of ids) {
    const kind = registry[id];
    for (let k = 0; k < each; ++k) {
      const message = new kind();
      for (const field of kind.FIELDS) if (!field.extension) message[field.name] = anyValue(field);
      const header = { msgid: kind.MSG_ID, seq: k % 256, sysid: random() % 256, compid: random() % 256 };
      frames.push(withoutExtensions(kind, new MavLinkProtocolV1(header.sysid, header.compid).serialize(message, header.seq)));
      written.push(described(header, kind, message));
    }
  }
  writeFileSync(file, Buffer.concat(frames));
  return written;
}

const [what, file, each, ...ids] = process.argv.slice(2);
console.log(JSON.stringify(what === "read" ? await read(file) : write(file, Number(each), ids)));
