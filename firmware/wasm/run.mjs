// Runs generated code in a WebAssembly module and prints what the certificate reads.
//
//   node run.mjs MODULE < CALLS
//
// A line of CALLS has five columns: what to print before the results, the exported function, the bytes of a number, how many
// joints, and the bits of positions, velocities and accelerations in hexadecimal.
import { readFileSync } from "node:fs";

const module = await WebAssembly.instantiate(readFileSync(process.argv[2]));
const { memory, __heap_base: free, ...functions } = module.instance.exports;
const view = new DataView(memory.buffer);

const access = {
    4: {
        write: (at, word) => view.setUint32(at, Number(word), true),
        read: (at) => view.getUint32(at, true),
    },
    8: {
        write: (at, word) => view.setBigUint64(at, word, true),
        read: (at) => view.getBigUint64(at, true),
    },
};

for (const line of readFileSync(0, "utf8").trimEnd().split("\n")) {
    const [what, name, size, count, bits] = line.split("\t");
    const { write, read } = access[size];
    bits.split(" ").forEach((word, index) => write(free.value + index * size, BigInt(`0x${word}`)));
    functions[name](...[0, 1, 2, 3].map((vector) => free.value + vector * count * size));
    const torques = Array.from({ length: count }, (_, joint) => read(free.value + (3 * count + joint) * size));
    const text = torques.map((word) => word.toString(16).padStart(2 * size, "0"));
    console.log([what, ...text].join(" "));
}
