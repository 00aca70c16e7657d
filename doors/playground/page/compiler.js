// The compiler in a worker: the last text that is asked for is answered, those before it may be left out.

/** How long a text may take before a newer one stops it, ms. */
const PATIENCE = 5000;

/** Base64 of deflated or gzipped bytes, as bytes; null when there are more than `most`. */
async function unpacked(text, format, most = Infinity) {
  const packed = Uint8Array.from(atob(text.trim()), (c) => c.charCodeAt(0));
  const reader = new Blob([packed]).stream().pipeThrough(new DecompressionStream(format)).getReader();
  const parts = [];
  let length = 0;
  for (;;) {
    const { done, value } = await reader.read();
    if (done) return new Uint8Array(await new Blob(parts).arrayBuffer());
    length += value.length;
    if (length > most) {
      // a thousand times the letters of a link may come out: what is not asked for is not inflated
      reader.cancel();
      return null;
    }
    parts.push(value);
  }
}

class Compiler {
  /** `answered` gets what the compiler says of a text, and the text. */
  constructor(module, worker, answered) {
    this.module = module;
    this.url = URL.createObjectURL(new Blob([worker], { type: "text/javascript" }));
    this.answered = answered;
    this.number = 0;
    this.begin();
  }

  begin() {
    this.asked = null;
    this.worker = new Worker(this.url);
    this.worker.onmessage = ({ data }) => {
      const asked = this.asked;
      this.asked = null;
      const { next } = this;
      this.next = null;
      if (next) this.ask(next);
      else if (asked) this.answered(data, asked);
    };
    this.worker.postMessage({ module: this.module });
  }

  /** Asks for a text; `asked.text`, and whatever else shall come back with the answer. */
  ask(asked) {
    if (this.asked) {
      this.next = asked;
      if (performance.now() - this.asked.since < PATIENCE) return;
      this.worker.terminate();
      this.next = null;
      this.begin();
    }
    this.asked = { ...asked, since: performance.now() };
    this.worker.postMessage({ number: ++this.number, text: asked.text });
  }
}
