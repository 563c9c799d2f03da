// Asks the worker. One question is answered at a time; a newer one of the same kind takes the place of one that waits.

/// Milliseconds after which a question is given up.
const PATIENCE = 1000;

const client = { module: null, worker: null, ready: null, asked: null, waiting: new Map(), count: 0 };

async function loadWorker() {
  const bytes = Uint8Array.from(atob(element("wasm").textContent), letter => letter.charCodeAt(0));
  const plain = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  client.module = await WebAssembly.compile(await new Response(plain).arrayBuffer());
  await newWorker();
}

function newWorker() {
  client.worker?.terminate();
  const url = URL.createObjectURL(new Blob([element("worker").textContent], { type: "text/javascript" }));
  client.worker = new Worker(url);
  client.ready = new Promise(done => {
    client.worker.onmessage = ({ data }) => (data.ready ? done() : answered(data));
  });
  client.worker.postMessage({ module: client.module });
  return client.ready;
}

/// The answer, or an error; `null` if a newer question of this kind was asked before its turn.
function ask(kind, given) {
  client.waiting.get(kind)?.done(null);
  return new Promise((done, failed) => {
    client.waiting.set(kind, { kind, given, done, failed });
    next();
  });
}

async function next() {
  const [first] = client.waiting.values();
  if (client.asked || !first) return;
  client.waiting.delete(first.kind);
  client.asked = { ...first, id: ++client.count };
  await client.ready;
  client.asked.clock = setTimeout(giveUp, PATIENCE);
  client.worker.postMessage({ ...first.given, kind: first.kind, id: client.asked.id });
}

function answered({ id, answer, error, took }) {
  if (id !== client.asked?.id) return;
  const { done, failed, clock } = client.asked;
  clearTimeout(clock);
  client.asked = null;
  if (error === undefined) done({ ...answer, took });
  else failed(new Error(error));
  next();
}

function giveUp() {
  const { kind, failed } = client.asked;
  client.asked = null;
  newWorker();
  failed(new Error(kind === "read" ? "This takes longer than a second to derive. #[derive(Lagrangian)] has no such limit." : "The motion takes longer than a second to compute: take a shorter time or another method."));
  next();
}
