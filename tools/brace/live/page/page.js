// The stream of messages, and a picture for every limb that is in it. Words come when they change, numbers always.
import { Limb } from "./limb.js";
import { StanceCard } from "./stance.js";

const AGAIN_MS = 1000;
const bus = document.getElementById("bus");
const trouble = document.getElementById("trouble");
const main = document.getElementById("limbs");
const limbs = new Map();
const words = new Map(); // of a limb, by its node
const stance = new StanceCard(document.getElementById("stance"));
let newest = null;
let newestStance = null;

function tell(message) {
  bus.textContent = message.ended ? `${message.bus}: ${message.ended}` : message.bus;
  trouble.hidden = message.trouble === "";
  if (trouble.textContent !== message.trouble) {
    trouble.textContent = message.trouble;
  }
  for (const one of message.words) {
    words.set(one.node, one);
  }
}

function show(numbers) {
  const { node } = numbers;
  if (!limbs.has(node)) {
    const limb = new Limb(document.getElementById("limb").content.firstElementChild.cloneNode(true));
    limbs.set(node, limb);
    main.append(limb.element);
  }
  limbs.get(node).show({ ...words.get(node), ...numbers });
}

function draw() {
  if (newest !== null) {
    newest.forEach(show);
    newest = null;
  }
  if (newestStance !== null) {
    stance.show(newestStance);
    newestStance = null;
  }
  requestAnimationFrame(draw);
}

function listen() {
  const stream = new WebSocket(`ws://${location.host}/live`);
  stream.onmessage = (event) => {
    const message = JSON.parse(event.data);
    if (message.words !== undefined) {
      tell(message);
    } else {
      newest = message.numbers;
      newestStance = message.stance ?? null;
    }
  };
  stream.onclose = () => {
    bus.textContent = "brace monitor has ended, or does not answer; this page tries again";
    for (const limb of limbs.values()) {
      limb.lose();
    }
    stance.lose();
    setTimeout(listen, AGAIN_MS);
  };
}

listen();
requestAnimationFrame(draw);
