// A body on its limbs: a row for each foot, what happens beside them.
const AXES = ["x", "y", "z"];

function text(element, words) {
  if (element.textContent !== words) {
    element.textContent = words;
  }
}

function number(value, digits = 2) {
  return value.toFixed(digits).replace("-", "\u2212");
}

function vector(values, unit) {
  return `${values.map((value) => number(value)).join("  ")} ${unit}`;
}

export class StanceCard {
  constructor(element) {
    this.element = element;
    this.find = (selector) => element.querySelector(selector);
    this.rows = [];
  }

  show(view) {
    this.element.hidden = false;
    text(this.find("h2"), view.name || "Stance");
    const waits = view.waits_for.length ? `waits for ${view.waits_for.join(", ")}` : "";
    text(this.find(".state"), view.trouble || waits || this.state(view));
    const next = (limb) => `next to let go: ${limb}, at ${number(view.next_factor)} times the payload on top`;
    text(this.find(".next"), view.next_limb === null ? "" : next(view.next_limb));
    this.find("table").hidden = view.feet.length === 0;
    const most = Math.max(1e-3, ...view.feet.map((foot) => (foot.margin_n ?? 0) + (foot.margin_half_n ?? 0)));
    view.feet.forEach((foot, i) => this.foot(i, foot, most));
    const list = this.find(".events");
    while (list.children.length > view.events.length) {
      list.lastElementChild.remove();
    }
    view.events.forEach((line, i) => text(list.children[i] ?? list.appendChild(document.createElement("li")), line));
  }

  state(view) {
    if (view.feet.length === 0) {
      return "waits for forces";
    }
    const moved = vector(view.moved_mm, "mm");
    return `carries ${vector(view.carried_n, "N")} beyond its weight; has moved ${moved} since the start`;
  }

  foot(i, foot, most) {
    this.rows[i] ??= this.find("tbody").appendChild(this.find("template").content.firstElementChild.cloneNode(true));
    const row = this.rows[i];
    const cell = (name) => row.querySelector(`.${name}`);
    row.classList.toggle("alarm", foot.is_alarm);
    text(cell("foot"), foot.name);
    AXES.forEach((axis, k) => text(cell(axis), `${number(foot.force_n[k])} \u00b1 ${number(foot.half_n[k])}`));
    const isDown = foot.margin_n !== null;
    text(cell("margin-text"), isDown ? `${number(foot.margin_n)} \u00b1 ${number(foot.margin_half_n)}` : "in the air");
    const bar = cell("bar");
    bar.style.display = isDown ? "" : "none";
    if (isDown) {
      const share = (value) => Math.min(100, Math.max(0, (100 * value) / most));
      const low = share(foot.margin_n - foot.margin_half_n);
      cell("sure").setAttribute("width", low);
      cell("unsure").setAttribute("x", low);
      cell("unsure").setAttribute("width", share(foot.margin_n + foot.margin_half_n) - low);
    }
    text(cell("age"), foot.age_ms === null ? "-" : `${foot.age_ms} ms`);
    text(cell("why"), [...(foot.is_alarm ? ["ALARM: may let go"] : []), ...foot.why].join(", "));
  }

  lose() {
    text(this.find(".state"), "brace monitor does not answer: what follows is old");
  }
}
