"use strict";

// The program in a thread of its own: a question in, an answer out.
let program;

function ask(question) {
  const bytes = new TextEncoder().encode(JSON.stringify(question));
  const place = program.room(bytes.length);
  new Uint8Array(program.memory.buffer, place, bytes.length).set(bytes);
  program.ask();
  const answer = new Uint8Array(program.memory.buffer, program.answer(), program.length());
  return JSON.parse(new TextDecoder().decode(answer));
}

onmessage = ({ data }) => {
  if (data instanceof WebAssembly.Module) {
    program = new WebAssembly.Instance(data, {}).exports;
    return;
  }
  try {
    postMessage(ask(data));
  } catch {
    // A defect of the program, or its memory is used up: no verdict.
    postMessage({ defect: true });
  }
};
