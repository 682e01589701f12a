// Reads a ULog file with somebody else's library and prints, as JSON, of every topic and publisher how many messages it
// has and the SHA-256 of all their values, in the order of time: whole numbers of 64 bits as they are, other numbers as
// doubles, text as its bytes, each array element by element, what is padding left out.
//
//   node read_ulog.mjs flight.ulg

import { createHash } from "node:crypto";
import { MessageType, ULog } from "@foxglove/ulog";
import { FileReader } from "@foxglove/ulog/node.js";

const ulog = new ULog(new FileReader(process.argv[2]));
await ulog.open();
const definitions = ulog.header.definitions;

function add(hash, value, field) {
  if (field.isComplex) {
    const inner = definitions.get(field.type);
    for (const element of field.arrayLength === undefined ? [value] : value) addFields(hash, element, inner);
  } else if (typeof value === "string") {
    hash.update(value, "utf8");
  } else if (Array.isArray(value) || ArrayBuffer.isView(value)) {
    for (const element of value) addNumber(hash, element);
  } else {
    addNumber(hash, value);
  }
}

function addNumber(hash, value) {
  const bytes = Buffer.alloc(8);
  if (typeof value === "bigint") bytes.writeBigInt64LE(BigInt.asIntN(64, value));
  else bytes.writeDoubleLE(Number.isNaN(Number(value)) ? NaN : Number(value));
  hash.update(bytes);
}

function addFields(hash, message, definition) {
  for (const field of definition.fields) {
    if (!field.name.startsWith("_")) add(hash, message[field.name], field);
  }
}

const series = {};
let dropouts = 0;
let texts = 0;
for await (const message of ulog.readMessages()) {
  if (message.type === MessageType.Dropout) dropouts += 1;
  if (message.type === MessageType.Log || message.type === MessageType.LogTagged) texts += 1;
  if (message.type !== MessageType.Data) continue;
  const subscription = ulog.subscriptions.get(message.msgId);
  const name = `${subscription.name}[${subscription.multiId}]`;
  series[name] ??= { count: 0, hash: createHash("sha256") };
  series[name].count += 1;
  addFields(series[name].hash, message.value, subscription);
}
for (const found of Object.values(series)) {
  found.sha256 = found.hash.digest("hex");
  delete found.hash;
}
const parameters = {};
// A default value that the log tells as well takes the place of the parameter's own here.
for (const [name, entry] of ulog.header.parameters) parameters[name] = entry.defaultTypes === 0 ? entry.value : null;
const information = {};
for (const [name, value] of ulog.header.information) {
  if (typeof value === "string") information[name] = value;
}
console.log(JSON.stringify({ series, parameters, information, dropouts, texts }));
