// Runs an ONNX model on states and prints its actions as JSON: node run_onnx.mjs RUNTIME MODEL STATES FIELDS [MASKS]
import fs from 'node:fs';

const [runtime, model, states, fields, masks] = process.argv.slice(2);
const ort = await import(runtime);
const session = await ort.InferenceSession.create(fs.readFileSync(model));
const bytes = fs.readFileSync(states);
const numbers = new Float32Array(bytes.buffer, bytes.byteOffset, bytes.length / 4);
const batch = numbers.length / Number(fields);
const inputs = { state: new ort.Tensor('float32', numbers, [batch, Number(fields)]) };
if (masks !== undefined) {
  const allowed = new Uint8Array(fs.readFileSync(masks));
  inputs.mask = new ort.Tensor('bool', allowed, [batch, allowed.length / batch]);
}
const result = await session.run(inputs);
console.log(JSON.stringify({
  action: Array.from(result.action.data, Number),
  values: Array.from(result.values.data),
  mask: result.mask === undefined ? null : Array.from(result.mask.data, Number),
}));
