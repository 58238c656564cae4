// Reads a bag with Foxglove's libraries (npm: @mcap/core, @foxglove/rosmsg, @foxglove/rosmsg2-serialization,
// @foxglove/wasm-zstd, @foxglove/rosbag2, sql.js) and says as JSON what it holds, decoded:
//
//   node read_bag.cjs FILE.mcap | FILE.db3
const fs = require("fs");
const path = require("path");

// What is said of a message: numbers that a wrong encoding or definition would change.
function digest(message) {
  if (message.point_step !== undefined) {
    const view = new DataView(message.data.buffer, message.data.byteOffset, message.data.byteLength);
    let points = 0;
    for (let at = 0; at < message.data.byteLength; at += message.point_step) {
      if (!Number.isNaN(view.getFloat32(at, true))) ++points;
    }
    return { frame: message.header.frame_id, width: message.width, height: message.height,
             fields: message.fields.map((field) => field.name).join(","), points };
  }
  if (message.transforms !== undefined) {
    return message.transforms.map((tf) => `${tf.header.frame_id}>${tf.child_frame_id}`);
  }
  if (message.entities !== undefined) {
    return message.entities.map((entity) => ({ id: entity.id, lines: entity.lines.length,
      cubes: entity.cubes.length, texts: entity.texts.map((text) => text.text) }));
  }
  if (message.pose !== undefined) {
    return { x: message.pose.pose.position.x, speed: message.twist.twist.linear.x };
  }
  if (message.twist !== undefined) return message.twist.linear.x;
  if (message.linear_acceleration !== undefined) return message.linear_acceleration.z;
  if (message.latitude !== undefined) return message.status.status;
  if (message.format !== undefined) return message.format;
  if (message.distortion_model !== undefined) return message.k[0];
  return message.clock;
}

function note(topics, name, type, time, message) {
  const seen = topics[name] ?? (topics[name] = { type, times: [], first: digest(message) });
  seen.times.push(Number(time));
}

async function readMcap(file) {
  const { McapIndexedReader } = require("@mcap/core");
  const { FileHandleReadable } = require("@mcap/nodejs");
  const zstd = require("@foxglove/wasm-zstd");
  const { parse } = require("@foxglove/rosmsg");
  const { MessageReader } = require("@foxglove/rosmsg2-serialization");
  await zstd.isLoaded;
  const handle = await fs.promises.open(file, "r");
  const reader = await McapIndexedReader.Initialize({
    readable: new FileHandleReadable(handle),
    decompressHandlers: { zstd: (bytes, size) => zstd.decompress(bytes, Number(size)) },
  });
  const decoders = new Map();
  const topics = {};
  for await (const message of reader.readMessages()) {
    const channel = reader.channelsById.get(message.channelId);
    const schema = reader.schemasById.get(channel.schemaId);
    if (!decoders.has(channel.id)) {
      const text = new TextDecoder().decode(schema.data);
      decoders.set(channel.id, new MessageReader(parse(text, { ros2: true })));
    }
    note(topics, channel.topic, schema.name, message.logTime,
         decoders.get(channel.id).readMessage(message.data));
  }
  const attachments = [];
  for await (const attachment of reader.readAttachments()) attachments.push(attachment.name);
  await handle.close();
  return { profile: reader.header.profile, chunks: reader.chunkIndexes.length, topics, attachments };
}

// Foxglove's reader decodes by definitions of its own, and leaves SQLite to the program.
async function readRosbag2(file) {
  const { Rosbag2 } = require("@foxglove/rosbag2");
  const SQL = await require("sql.js")();
  const database = new SQL.Database(fs.readFileSync(file));
  const rows = (query) => {
    const found = database.exec(query)[0];
    return found === undefined ? [] : found.values;
  };
  const time = (ns) => ({ sec: Math.floor(ns / 1e9), nsec: ns % 1e9 });
  const definitions = rows("SELECT name, type, serialization_format FROM topics").map(
    ([name, type, serializationFormat]) => ({ name, type, serializationFormat, offeredQosProfiles: [] }));
  const adapter = {
    open: async () => {},
    close: async () => {},
    readTopics: async () => definitions,
    readMessages: async function* () {
      const query = "SELECT t.name, m.timestamp, m.data FROM messages m JOIN topics t ON " +
                    "t.id = m.topic_id ORDER BY m.timestamp, m.id";
      for (const [name, timestamp, data] of rows(query)) {
        yield { topic: definitions.find((topic) => topic.name === name), timestamp: time(timestamp), data };
      }
    },
  };
  const bag = new Rosbag2([adapter]);
  await bag.open();
  const topics = {};
  for await (const message of bag.readMessages()) {
    note(topics, message.topic.name, message.topic.type,
         message.timestamp.sec * 1e9 + message.timestamp.nsec, message.value);
  }
  return { topics };
}

const file = process.argv[2];
const read = path.extname(file) === ".mcap" ? readMcap : readRosbag2;
read(file).then((found) => console.log(JSON.stringify(found)));
