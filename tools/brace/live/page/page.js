// The stream of messages, and a picture for every limb that is in it.
import { Limb } from "./limb.js";

const AGAIN_MS = 1000;
const bus = document.getElementById("bus");
const trouble = document.getElementById("trouble");
const main = document.getElementById("limbs");
const limbs = new Map();
let newest = null;

function show(message) {
  bus.textContent = message.ended ? `${message.bus}: ${message.ended}` : message.bus;
  trouble.hidden = message.trouble === "";
  if (trouble.textContent !== message.trouble) {
    trouble.textContent = message.trouble;
  }
  for (const view of message.limbs) {
    if (!limbs.has(view.node)) {
      const limb = new Limb(document.getElementById("limb").content.firstElementChild.cloneNode(true));
      limbs.set(view.node, limb);
      main.append(limb.element);
    }
    limbs.get(view.node).show(view);
  }
}

function draw() {
  if (newest !== null) {
    show(newest);
    newest = null;
  }
  requestAnimationFrame(draw);
}

function listen() {
  const stream = new WebSocket(`ws://${location.host}/live`);
  stream.onmessage = (event) => {
    newest = JSON.parse(event.data);
  };
  stream.onclose = () => {
    bus.textContent = "brace monitor has ended, or does not answer; this page tries again";
    for (const limb of limbs.values()) {
      limb.element.classList.add("silent");
    }
    setTimeout(listen, AGAIN_MS);
  };
}

listen();
requestAnimationFrame(draw);
