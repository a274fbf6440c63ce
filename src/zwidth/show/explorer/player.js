// A motion played back: the handle goes to and fro at the wall, an arrow is the force on it. It moves only when
// it is asked to, for those whom motion on a page disturbs.

const NAMESPACE = "http://www.w3.org/2000/svg";
const SECONDS = 6;

export function render({ model }) {
  const root = document.createElement("div");
  const svg = shape("svg", { viewBox: "0 0 600 130", role: "img", "aria-label": "the handle at the wall" });
  const wall = shape("rect", { y: 10, height: 96, class: "wall" });
  const ground = shape("line", { x1: 0, x2: 600, y1: 106, y2: 106, class: "ground" });
  const handle = shape("circle", { cy: 80, r: 18, class: "handle" });
  const arrow = shape("line", { y1: 38, y2: 38, class: "arrow" });
  const head = shape("polygon", { class: "head" });
  svg.append(wall, ground, handle, arrow, head);
  const words = Object.assign(document.createElement("p"), { className: "said" });
  const range = Object.assign(document.createElement("input"), { type: "range", min: 0, value: 0, step: 1 });
  range.setAttribute("aria-label", "instant of the motion");
  const play = button("Play");
  const step = button("Step");
  const controls = document.createElement("div");
  controls.className = "controls";
  controls.append(play, step, range);
  root.append(svg, controls, words);

  let at = 0;
  let playing = 0;
  const shown = () => model.motion.times || [];
  const draw = () => {
    const { times, positions, forces, energies, length, force, energy, time } = model.motion;
    root.hidden = !times || times.length < 2;
    if (root.hidden) return;
    range.max = times.length - 1;
    range.value = at;
    const low = Math.min(0, ...positions);
    const high = Math.max(0, ...positions);
    const scale = 400 / (high - low || 1);
    const place = (x) => 100 + scale * (x - low);
    const most = Math.max(...forces.map(Math.abs), 1e-300);
    const x = place(positions[at]);
    const size = -100 * (forces[Math.min(at, forces.length - 1)] / most);
    set(wall, { x: place(0), width: 600 - place(0) });
    set(handle, { cx: x });
    set(arrow, { x1: x, x2: x + size });
    const tip = x + size;
    const back = Math.sign(size) * Math.min(10, Math.abs(size));
    set(head, { points: `${tip},38 ${tip - back},32 ${tip - back},44` });
    const text = `t = ${number(times[at])} ${time}, x = ${number(positions[at])} ${length}, ` +
      `force on the handle ${number(-forces[Math.min(at, forces.length - 1)])} ${force}, energy out ${number(energies[at])} ${energy}`;
    words.textContent = text;
    range.setAttribute("aria-valuetext", text);
  };
  const stop = () => {
    cancelAnimationFrame(playing);
    playing = 0;
    play.textContent = "Play";
  };
  const run = () => {
    const times = shown();
    if (at >= times.length - 1) at = 0;
    const whole = times[times.length - 1] - times[0];
    const began = performance.now() - (1000 * SECONDS * (times[at] - times[0])) / whole;
    play.textContent = "Pause";
    const frame = (now) => {
      const until = times[0] + ((now - began) / (1000 * SECONDS)) * whole;
      while (at < times.length - 1 && times[at + 1] <= until) at += 1;
      draw();
      if (at >= times.length - 1) stop();
      else playing = requestAnimationFrame(frame);
    };
    playing = requestAnimationFrame(frame);
  };
  play.addEventListener("click", () => (playing ? stop() : run()));
  step.addEventListener("click", () => {
    stop();
    at = (at + 1) % shown().length;
    draw();
  });
  range.addEventListener("input", () => {
    stop();
    at = Number(range.value);
    draw();
  });
  model.on("motion", () => {
    stop();
    at = 0;
    draw();
  });
  draw();
  return root;
}

function shape(tag, attributes) {
  return set(document.createElementNS(NAMESPACE, tag), attributes);
}

function set(element, attributes) {
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  return element;
}

function button(text) {
  return Object.assign(document.createElement("button"), { type: "button", textContent: text });
}

function number(value) {
  return value.toPrecision(3).replace("-", "\u2212");
}
