// Reads an MCAP file with other people's libraries, from front to back and through its indexes, decodes every message,
// and prints what it found as JSON.
//
//   node read_log.mjs flight.mcap [topic:index:field.path ...]

import { readFileSync } from "node:fs";
import { open } from "node:fs/promises";
import { decompress } from "fzstd";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { parse } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";

const [file, ...wanted] = process.argv.slice(2);
const decompressHandlers = { zstd: (bytes) => decompress(bytes) };
const decoder = new TextDecoder();

function messageReader(schema) {
  if (schema.encoding !== "ros2msg") throw new Error(`${schema.name}: encoding ${schema.encoding}`);
  return new MessageReader(parse(decoder.decode(schema.data), { ros2: true }));
}

function plain(value) {
  if (typeof value === "bigint") return value.toString();
  if (ArrayBuffer.isView(value)) return Array.from(value, plain);
  return value;
}

/** Everything in the file in the order of its bytes; checks every checksum on the way. */
function readStream() {
  const reader = new McapStreamReader({ decompressHandlers, validateCrcs: true });
  reader.append(readFileSync(file));
  const found = { header: null, topics: {}, metadata: {}, statistics: null, chunks: 0, closed: false };
  const schemas = new Map();
  const channels = new Map();
  for (let record; (record = reader.nextRecord()); ) {
    switch (record.type) {
      case "Header": {
        const { profile, library } = record;
        found.header = { profile, library };
        break;
      }
      case "Schema":
        if (!schemas.has(record.id)) schemas.set(record.id, { name: record.name, reader: messageReader(record) });
        break;
      case "Channel":
        channels.set(record.id, record);
        found.topics[record.topic] ??= { schema: schemas.get(record.schemaId).name, encoding: record.messageEncoding,
                                         qos: record.metadata.has("offered_qos_profiles"), count: 0, messages: [] };
        break;
      case "Message": {
        const channel = channels.get(record.channelId);
        const topic = found.topics[channel.topic];
        topic.messages.push({ time: record.logTime,
                              value: schemas.get(channel.schemaId).reader.readMessage(record.data) });
        ++topic.count;
        break;
      }
      case "Metadata": found.metadata[record.name] = Object.fromEntries(record.metadata); break;
      case "ChunkIndex": ++found.chunks; break;
      case "Statistics":
        found.statistics = { messages: plain(record.messageCount), schemas: record.schemaCount,
                             channels: record.channelCount, chunks: record.chunkCount,
                             metadata: record.metadataCount };
        break;
      case "Footer": found.closed = true; break;
    }
  }
  if (!reader.done()) throw new Error("the file does not end where its records do");
  return found;
}

/** The number of messages that the indexes lead to, and whether their times never go back. */
async function readIndexed() {
  const handle = await open(file);
  const readable = {
    size: async () => BigInt((await handle.stat()).size),
    read: async (offset, length) => {
      const bytes = new Uint8Array(Number(length));
      await handle.read(bytes, 0, Number(length), Number(offset));
      return bytes;
    },
  };
  const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
  let count = 0;
  let ordered = true;
  let last = 0n;
  for await (const message of reader.readMessages({ validateCrcs: true })) {
    ++count;
    ordered &&= message.logTime >= last;
    last = message.logTime;
  }
  await handle.close();
  return { count, ordered };
}

function pick(found, text) {
  const [topic, index, path] = text.split(":");
  const message = found.topics[topic].messages[Number(index)];
  if (path === "time") return message.time.toString();
  return plain(path.split(".").reduce((value, key) => value?.[key], message.value)) ?? null;
}

const found = readStream();
const indexed = found.chunks > 0 ? await readIndexed() : null;
const values = Object.fromEntries(wanted.map((text) => [text, pick(found, text)]));
for (const topic of Object.values(found.topics)) delete topic.messages;
console.log(JSON.stringify({ ...found, indexed, values }));
