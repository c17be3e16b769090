// Print what Khronos' own validator says about a glTF file, as JSON.
const fs = require("fs");
const validator = require(process.argv[2] + "/gltf-validator");

validator
  .validateBytes(new Uint8Array(fs.readFileSync(process.argv[3])))
  .then((report) => console.log(JSON.stringify(report)));
