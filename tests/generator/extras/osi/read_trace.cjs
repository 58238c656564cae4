// Reads an OSI trace as Foxglove does, by the definitions inside it (npm: @mcap/core, @mcap/nodejs,
// @foxglove/wasm-zstd, protobufjs), and says as JSON what it holds:
//
//   node read_trace.cjs FILE.mcap
const fs = require("fs");
const { McapIndexedReader } = require("@mcap/core");
const { FileHandleReadable } = require("@mcap/nodejs");
const zstd = require("@foxglove/wasm-zstd");
const protobuf = require("protobufjs");
const { FileDescriptorSet } = require("protobufjs/ext/descriptor");

async function read(file) {
  await zstd.isLoaded;
  const handle = await fs.promises.open(file, "r");
  const reader = await McapIndexedReader.Initialize({
    readable: new FileHandleReadable(handle),
    decompressHandlers: { zstd: (bytes, size) => zstd.decompress(bytes, Number(size)) },
  });
  const found = { profile: reader.header.profile, chunks: reader.chunkIndexes.length, metadata: {}, views: [] };
  for await (const record of reader.readMetadata()) {
    found.metadata[record.name] = Object.fromEntries(record.metadata);
  }
  for await (const message of reader.readMessages()) {
    const channel = reader.channelsById.get(message.channelId);
    const schema = reader.schemasById.get(channel.schemaId);
    const root = protobuf.Root.fromDescriptor(FileDescriptorSet.decode(schema.data));
    const view = root.resolveAll().lookupType(schema.name).decode(message.data);
    const lidar = view.lidar_sensor_view[0];
    found.views.push({
      time: Number(message.logTime),
      nanos: view.timestamp.nanos,
      objects: view.global_ground_truth.moving_object.length + view.global_ground_truth.stationary_object.length,
      rays: lidar.reflection.length,
      directions: lidar.view_configuration.directions.length,
      points: lidar.reflection.filter((reflection) => reflection.time_of_flight > 0).length,
    });
  }
  await handle.close();
  return found;
}

read(process.argv[2]).then((found) => console.log(JSON.stringify(found)));
