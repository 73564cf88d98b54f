// Prints an MCAP file as JSON: node read_mcap.mjs NODE_MODULES FILE. Read by its index, and again from its beginning to
// its end, where every CRC is checked.
import fs from 'node:fs';
import path from 'node:path';
import { createRequire } from 'node:module';

const [modules, file] = process.argv.slice(2);
const require = createRequire(path.join(path.resolve(modules), 'x.js'));
const { McapIndexedReader, McapStreamReader } = require('@mcap/core');
const { protobufFromBinaryDescriptor } = require('@mcap/support');

const bytes = fs.readFileSync(file);
const reader = await McapIndexedReader.Initialize({
  readable: {
    size: async () => BigInt(bytes.length),
    read: async (offset, size) => new Uint8Array(bytes.subarray(Number(offset), Number(offset + size))),
  },
});
const types = new Map();
for (const [id, schema] of reader.schemasById) {
  types.set(id, [schema.encoding, protobufFromBinaryDescriptor(schema.data).lookupType(schema.name)]);
}
const messages = [];
for await (const { channelId, sequence, logTime, publishTime, data } of reader.readMessages()) {
  const channel = reader.channelsById.get(channelId);
  const [encoding, type] = types.get(channel.schemaId);
  messages.push({
    topic: channel.topic, encodings: [channel.messageEncoding, encoding], type: type.name, sequence,
    logTime: String(logTime), publishTime: String(publishTime),
    message: type.toObject(type.decode(data), { arrays: true, bytes: Array, longs: String }),
  });
}
let streamed = 0;
const stream = new McapStreamReader({ validateCrcs: true });
stream.append(bytes);
for (let record; (record = stream.nextRecord());) {
  streamed += record.type === 'Message' ? 1 : 0;
}
console.log(JSON.stringify({
  statistics: Number(reader.statistics.messageCount), streamed, done: stream.done(), chunks: reader.chunkIndexes.length,
  topics: [...reader.channelsById.values()].map((channel) => channel.topic), messages,
}));
