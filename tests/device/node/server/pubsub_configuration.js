// Decodes a UABinaryFile with a PubSubConfigurationDataType by node-opcua, and encodes it again; prints what it holds as one JSON object.
//
// usage: node pubsub_configuration.js MODULES FILE
"use strict";
const fs = require("fs");
const path = require("path");

const [modules, file] = process.argv.slice(2);
const { BinaryStream } = require(path.resolve(modules, "node-opcua-binary-stream"));
const { decodeExtensionObject, encodeExtensionObject } = require(path.resolve(modules, "node-opcua-extension-object"));
require(path.resolve(modules, "node-opcua-types"));

const octets = fs.readFileSync(file);
const stream = new BinaryStream(octets);
const whole = decodeExtensionObject(stream);
const again = new BinaryStream(Buffer.alloc(octets.length + 1024));
encodeExtensionObject(whole, again);
const plain = (_, value) => (typeof value === "bigint" ? String(value) : value);
console.log(JSON.stringify({
  rest: octets.length - stream.length,
  same: again.buffer.subarray(0, again.length).equals(octets),
  type: whole.constructor.name,
  body: whole.body.value.constructor.name,
  configuration: whole.body.value,
}, plain));
