// One limb: drawn to scale at its posture, with its ellipse of stiffness, its numbers, and the last minute.
const HISTORY_MS = 60_000;
const HISTORY_STEP_MS = 100;
const ELLIPSE_SHARE = 0.3; // of the reach: the longer half axis
const SCALE_SHARE = 0.1; // of the reach: room for the scale's bar below
const AVERAGE_MS = 1000; // of force and displacement, which jitter from message to message
const SMALL_N = 0.05; // no arrow below
const NO_SIGMA = 1e-6; // of a value: less is the rounding of a mean of equal readings
const LONGEST_N = 20; // this and more has the longest arrow
const ROUND = [1, 2, 5];
const JOINTS = ["coxa", "femur", "tibia"];

function text(element, words) {
  if (element.textContent !== words) {
    element.textContent = words;
  }
}

function set(element, attributes) {
  for (const [name, value] of Object.entries(attributes)) {
    element.setAttribute(name, value);
  }
}

function number(value, digits = 3) {
  return value === null || value === undefined ? "-" : value.toPrecision(digits).replace("-", "\u2212");
}

function numbers(values, unit, digits = 3) {
  return values.every((value) => value === null) ? "-" : `${values.map((v) => number(v, digits)).join(", ")} ${unit}`;
}

// Values with one sigma of each behind them, where it is known. A line does not end between a value and its sigma.
function trusted(values, sigmas, unit) {
  const one = (value, i) => withSigma(value, sigmas?.[i] ?? null);
  return values.every((value) => value === null) ? "-" : `${values.map(one).join(", ")} ${unit}`;
}

// Two digits of the sigma, and the value to the same place: what is beyond it is noise.
function withSigma(value, sigma) {
  if (value === null || sigma === null || !(sigma > NO_SIGMA * Math.abs(value))) {
    return number(value);
  }
  const places = Math.max(0, 1 - Math.floor(Math.log10(Number(sigma.toPrecision(2)))));
  const rounded = Number(value.toFixed(places)) === 0 ? 0 : value; // not -0.00
  return `${rounded.toFixed(places).replace("-", "\u2212")}\u00a0\u00b1\u00a0${sigma.toFixed(places)}`;
}

// Of rows of values, the mean of each column and the standard deviation of its readings; null where none has one.
function averaged(rows) {
  const columns = (rows[0] ?? []).map((_, i) => rows.map((row) => row[i]).filter((value) => value !== null));
  const means = columns.map((values) => (values.length ? values.reduce((a, b) => a + b) / values.length : null));
  const sigmas = columns.map((values, i) => (
    values.length < 2 ? null : Math.sqrt(values.reduce((a, b) => a + (b - means[i]) ** 2, 0) / (values.length - 1))
  ));
  return [means, sigmas];
}

function degrees(rad) {
  return rad === null ? "-" : `${number((rad * 180) / Math.PI, 4)}\u00b0`;
}

// A round number near a length, for a scale's bar.
function rounded(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return power * ROUND.findLast((step) => step * power <= value);
}

function ellipsePath(rx, ry) {
  return `M${-rx} 0A${rx} ${ry} 0 1 0 ${rx} 0A${rx} ${ry} 0 1 0 ${-rx} 0Z`;
}

// Knee and tip, x and z in the limb's plane from the femur joint: theta1 counts from +x, theta2 from the straight leg.
function places(view) {
  const [, theta1, theta2] = view.theta_rad;
  if (view.lengths_mm === null || theta1 === null || theta2 === null) {
    return null;
  }
  const [, femur, tibia] = view.lengths_mm;
  const knee = [femur * Math.cos(theta1), femur * Math.sin(theta1)];
  const shank = theta1 - theta2;
  return [knee, [knee[0] + tibia * Math.cos(shank), knee[1] + tibia * Math.sin(shank)]];
}

export class Limb {
  constructor(element) {
    this.element = element;
    this.history = [];
    this.loads = [];
    this.find = (selector) => element.querySelector(selector);
    this.rows = new Map();
  }

  show(view) {
    text(this.find("h2"), `Node ${view.node}${view.name ? ` \u00b7 ${view.name}` : ""}`);
    const silent = view.silent_s !== null;
    this.element.classList.toggle("silent", silent);
    this.element.classList.toggle("invalid", !view.is_valid);
    text(
      this.find(".mode"),
      silent ? `silent for ${view.silent_s.toFixed(0)} s: what follows is old` : `${view.mode}: ${view.mode_text}`,
    );
    this.tell(view);
    this.draw(view);
    this.list(".backlash", view.play.map((one) => `${one.joint}: ${one.text}`));
    this.list(".faults", view.faults.map((one) => `${one.name}. ${one.text}`));
    this.list(".flags", view.flags.map((one) => `${one.name}. ${one.text}`));
    this.remember(view);
  }

  list(selector, lines) {
    const list = this.find(selector);
    while (list.children.length > lines.length) {
      list.lastElementChild.remove();
    }
    lines.forEach((line, i) => text(list.children[i] ?? list.appendChild(document.createElement("li")), line));
  }

  row(name, words) {
    if (!this.rows.has(name)) {
      const term = document.createElement("dt");
      const value = document.createElement("dd");
      term.textContent = name;
      this.find(".numbers").append(term, value);
      this.rows.set(name, [term, value]);
    }
    const [term, value] = this.rows.get(name);
    term.hidden = value.hidden = words === null;
    text(value, words ?? "");
  }

  tell(view) {
    const { is_valid: valid, lambda_n_per_mm: lambdas } = view;
    const sigmas = view.relative_sigma?.map((share, i) => (lambdas[i] === null ? null : share * lambdas[i]));
    const [least, most] = lambdas.map((one, i) => trusted([one], [sigmas?.[i] ?? null], "N/mm"));
    this.row("softest", valid ? least : "K is not valid");
    this.row("stiffest", valid ? most : null);
    this.row("K xx, xz, zz", valid ? trusted(view.k_n_per_mm, view.sigma_k_n_per_mm, "N/mm") : null);
    const space = view.lambda_space_n_per_mm;
    const inSpace = view.sigma_lambda_space_n_per_mm;
    this.row("eigenvalues in space", space === null ? null : trusted(space, inSpace, "N/mm"));
    const unsure = valid && view.relative_sigma === null && view.sigma_k_n_per_mm === null;
    this.row("\u00b1 one sigma", unsure ? "not known: neither sent nor in a model" : null);
    const load = view.load;
    const now = performance.now();
    if (load === null || this.loads.length === 0 || view.silent_s === null) { // of a silent limb the last second stays
      this.loads = load === null ? [] : [...this.loads.filter((one) => now - one.at < AVERAGE_MS), { at: now, load }];
    }
    const second = (name, unit) => `${trusted(...averaged(this.loads.map((one) => one.load[name])), unit)}, last second`;
    this.row("force x, z", load === null ? view.load_why : second("force_n", "N"));
    this.row("tip moved x, z", load === null ? null : second("moved_mm", "mm"));
    this.row("K without load", load === null ? null : numbers(load.unloaded_k_n_per_mm, "N/mm"));
    const factor = load === null ? null : load.buckling_factor;
    this.row("buckling factor", load === null ? null : factor === null ? "none" : number(factor));
    JOINTS.forEach((name, i) => {
      const angle = view.theta_rad[i];
      this.row(`theta${i}, ${name}`, i === 0 && angle === null ? null : degrees(angle));
    });
    const age = view.age_ms === null ? "over 127 ms" : `${view.age_ms} ms`;
    const silent = view.silent_s === null ? null : `nothing for ${view.silent_s.toFixed(0)} s`;
    this.row("age of K's samples", silent === null ? age : `over ${view.silent_s.toFixed(0)} s`);
    this.row("K comes", silent ?? `${view.rate_hz.toFixed(0)} times a second`);
  }

  // Nobody says any more how old the numbers are.
  lose() {
    this.element.classList.add("silent");
    text(this.find(".mode"), "brace monitor does not answer: what follows is old");
    this.row("age of K's samples", "not known");
    this.row("K comes", "not known");
  }

  draw(view) {
    const svg = this.find("svg");
    const picture = this.find(".picture");
    const note = this.find(".note");
    const joined = places(view);
    const known = joined !== null;
    picture.style.display = this.find(".scale").style.display = known ? "" : "none";
    const reach = known ? view.lengths_mm[1] + view.lengths_mm[2] : 100;
    const box = this.frame(reach, joined ?? [], known ? view.lengths_mm[0] : 0);
    set(svg, { viewBox: `${box.left} ${box.top} ${box.right - box.left} ${box.bottom - box.top}` });
    text(note, known ? "" : view.lengths_mm === null ? view.lengths_why || "asking for lengths" : "posture not sent");
    set(note, { x: box.left, y: 0, "font-size": 0.05 * reach });
    if (!known) {
      return;
    }
    const width = 0.012 * reach;
    const [knee, tip] = joined.map(([x, z]) => [x, -z]);
    const joints = this.element.querySelectorAll(".joint");
    set(this.find(".horizon"), { x1: box.left, x2: box.right, y1: 0, y2: 0, "stroke-width": width / 3 });
    const coxa = [-view.lengths_mm[0], 0];
    set(this.find(".links"), { points: `${coxa} 0,0 ${knee} ${tip}`, "stroke-width": 2 * width });
    const names = this.element.querySelectorAll(".name");
    const below = Math.sign(knee[1]) || -1; // a name stands where no link leaves its joint
    [coxa, [0, 0], knee].forEach(([x, y], i) => {
      set(joints[i], { cx: x, cy: y, r: 2.2 * width, "stroke-width": width });
      const side = i === 2 ? below : -below;
      const anchor = ["end", "start", "middle"][i]; // a coxa may be shorter than the names
      set(names[i], { x, y: y + side * 5 * width + 1.5 * width, "font-size": 0.045 * reach, "text-anchor": anchor });
      text(names[i], JOINTS[i]);
    });
    set(this.find(".tip"), { cx: tip[0], cy: tip[1], r: 1.2 * width, "stroke-width": width / 2 });
    this.drawEllipse(view, reach, tip, width, box);
    this.drawForce(reach, tip, width);
    set(svg, { "aria-label": `limb of node ${view.node}, its posture and its stiffness ellipse` });
  }

  // What the picture shows: the joints and room for an ellipse about the tip. It grows with the places that the limb has
  // been to, and never shrinks, so that the picture does not shake.
  frame(reach, places, coxa) {
    const room = (ELLIPSE_SHARE + 0.06) * reach;
    this.box ??= { left: -0.1 * reach - coxa, top: -0.3 * reach, right: 0.8 * reach, bottom: 0.3 * reach };
    for (const [x, z] of places) {
      this.box.left = Math.min(this.box.left, x - room);
      this.box.right = Math.max(this.box.right, x + room);
      this.box.top = Math.min(this.box.top, -z - room);
      this.box.bottom = Math.max(this.box.bottom, -z + room + SCALE_SHARE * reach);
    }
    return this.box;
  }

  drawEllipse(view, reach, tip, width, box) {
    const [least, most] = view.lambda_n_per_mm;
    if (!view.is_valid || least === null || most === null || view.stiff_axis_rad === null) {
      return;
    }
    const [ofLeast, ofMost] = view.relative_sigma ?? [0, 0];
    const outer = Math.max(most * (1 + ofMost), least * (1 + ofLeast)); // of the band, so that the picture never cuts it
    const scale = (ELLIPSE_SHARE * reach) / outer; // mm of the picture for 1 N/mm
    const place = `translate(${tip}) rotate(${(-view.stiff_axis_rad * 180) / Math.PI})`;
    set(this.find(".ellipse"), {
      d: ellipsePath(most * scale, least * scale), transform: place, "stroke-width": width / 4,
    });
    const band = [1, -1].map((side) =>
      ellipsePath(Math.max(0, 1 + side * ofMost) * most * scale, Math.max(0, 1 + side * ofLeast) * least * scale));
    set(this.find(".band"), { d: band.join(""), transform: place });
    const bar = rounded(most);
    const [line, label] = this.find(".scale").children;
    const [x, y] = [box.left + width, box.bottom - width];
    set(line, { x1: x, x2: x + bar * scale, y1: y, y2: y, "stroke-width": width });
    set(label, { x, y: y - 2 * width, "font-size": 0.05 * reach });
    text(label, `${bar} N/mm`);
  }

  // The mean of the last second, as the row of numbers has it. A force within its scatter points anywhere: it has no arrow.
  drawForce(reach, tip, width) {
    const [[x = null, z = null], scatter] = averaged(this.loads.map((one) => one.load.force_n));
    const size = x === null || z === null ? 0 : Math.hypot(x, z);
    const isSeen = size > Math.max(SMALL_N, Math.hypot(...scatter.map((sigma) => sigma ?? 0)));
    const arrow = this.find(".force");
    arrow.style.display = isSeen ? "" : "none";
    if (!isSeen) {
      return;
    }
    const length = 0.3 * reach * Math.min(1, size / LONGEST_N);
    set(arrow, {
      x1: tip[0] - (length * x) / size, y1: tip[1] + (length * z) / size, x2: tip[0], y2: tip[1], "stroke-width": width,
    });
  }

  remember(view) {
    const now = performance.now();
    const last = this.history.at(-1);
    if (last !== undefined && now - last.at < HISTORY_STEP_MS) {
      return;
    }
    const [least, most] = view.is_valid && view.silent_s === null ? view.lambda_n_per_mm : [null, null];
    this.history.push({ at: now, least, most });
    while (now - this.history[0].at > HISTORY_MS) {
      this.history.shift();
    }
    this.drawHistory(now);
  }

  drawHistory(now) {
    const canvas = this.find(".history");
    const pen = canvas.getContext("2d");
    const style = getComputedStyle(this.element);
    const values = this.history.flatMap((one) => [one.least, one.most]).filter((value) => value !== null && value > 0);
    pen.clearRect(0, 0, canvas.width, canvas.height);
    if (values.length === 0) {
      const isThere = this.history.some((one) => one.most !== null);
      text(this.find("figcaption"), isThere ? "no K above zero in the last minute" : "no K has come in the last minute");
      return;
    }
    const low = Math.log(Math.min(...values) / 1.2);
    const high = Math.log(Math.max(...values) * 1.2);
    const x = (at) => canvas.width * (1 - (now - at) / HISTORY_MS);
    const y = (value) => canvas.height * (1 - (Math.log(value) - low) / (high - low));
    for (const [name, colour, dash] of [["most", "--stiff", []], ["least", "--soft", [8, 4]]]) {
      pen.strokeStyle = style.getPropertyValue(colour);
      pen.setLineDash(dash);
      pen.lineWidth = 3;
      pen.beginPath();
      let isDown = false;
      for (const one of this.history) {
        if (one[name] === null) {
          isDown = false;
          continue;
        }
        pen[isDown ? "lineTo" : "moveTo"](x(one.at), y(one[name]));
        isDown = true;
      }
      pen.stroke();
    }
    text(
      this.find("figcaption"),
      `last minute, logarithmic, ${number(Math.min(...values))} to ${number(Math.max(...values))} N/mm: ` +
        `stiffest (solid), ${this.history.some((one) => one.least > 0) ? "softest (dashed)" : "softest is 0: no line"}`,
    );
  }
}
