"use strict";

const at = (id) => document.getElementById(id);

// Longest proof, in milliseconds; the command line has more time.
const LONGEST = 30000;
// How long a proof may go on when there is a newer number, at least.
const PATIENCE = 150;
// Longest certificate that is tried again, in characters.
const LONG = 100000;
// How long nothing has to move before maps are drawn.
const STILL = 300;

const decoded = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
const program = WebAssembly.compile(decoded(at("program").textContent.trim()));
const source = URL.createObjectURL(new Blob([at("worker").textContent], { type: "text/javascript" }));

/** A thread that answers one question at a time, and can be stopped. */
class Helper {
  constructor() {
    this.begin();
  }

  begin() {
    this.worker = new Worker(source);
    program.then((module) => this.worker.postMessage(module));
  }

  get busy() {
    return Boolean(this.then);
  }

  /** The answer; null if it was stopped. */
  ask(question) {
    this.stop();
    return new Promise((then) => {
      this.then = then;
      this.worker.onmessage = ({ data }) => this.end(data);
      program.then(() => this.worker.postMessage(question));
    });
  }

  end(answer) {
    const then = this.then;
    this.then = null;
    if (answer?.defect) {
      this.worker.terminate();
      this.begin();
    }
    then?.(answer);
  }

  stop() {
    if (this.busy) {
      this.worker.terminate();
      this.begin();
      this.end(null);
    }
  }
}

const prover = new Helper();
const drawer = new Helper();
const finder = new Helper();

/** What is on the desk: the design, its numbers, whether they are yet to be read, and the answer. */
const desk = { machines: [], file: "", text: "", numbers: [], unread: true, answer: null };
