// Prints what Khronos' validator (npm: gltf-validator) finds in a glTF file, a line for each message, and its triangles:
//
//   node validate_glb.cjs FILE.glb
const fs = require("fs");
const validator = require("gltf-validator");

validator.validateBytes(new Uint8Array(fs.readFileSync(process.argv[2]))).then((report) => {
  for (const one of report.issues.messages) console.log(`${one.pointer}: ${one.code}: ${one.message}`);
  console.log(`${report.info.totalTriangleCount} triangles`);
});
