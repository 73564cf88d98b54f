// Runs an ONNX model on states and prints its actions as JSON: node run_onnx.mjs RUNTIME MODEL STATES FIELDS
import fs from 'node:fs';

const [runtime, model, states, fields] = process.argv.slice(2);
const ort = await import(runtime);
const session = await ort.InferenceSession.create(fs.readFileSync(model));
const bytes = fs.readFileSync(states);
const numbers = new Float32Array(bytes.buffer, bytes.byteOffset, bytes.length / 4);
const batch = numbers.length / Number(fields);
const state = new ort.Tensor('float32', numbers, [batch, Number(fields)]);
const result = await session.run({ state });
console.log(JSON.stringify({
  action: Array.from(result.action.data, Number),
  values: Array.from(result.values.data),
  mask: Array.from(result.mask.data, Number),
}));
