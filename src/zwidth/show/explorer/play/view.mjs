/* The page: what a person sees, hears and does. */

import { Player, loud, profile } from "./player.mjs";
import { Sound, Waveform } from "./sound.mjs";
import { SECONDS, dial, energy, stage, trace } from "./draw.mjs";

const PLACES = 160;
const SAID_EVERY_MS = 6000;
const TOLD_EVERY_MS = 250;
const STEP = 1 / 40;

export function start(root, plant, laws) {
    const all = JSON.parse(document.getElementById("facts").textContent);
    const page = new View(root, all, plant, laws);
    page.choose(0);
    new ResizeObserver(() => parent.postMessage(root.offsetHeight, "*")).observe(root); // what frames it makes room
    requestAnimationFrame((now) => page.frame(now));
    return page;
}

class View {
    constructor(root, all, plant, laws) {
        this.at = (id) => root.querySelector(`#${id}`);
        Object.assign(this, { root, all, plant, laws });
        this.sound = new Sound();
        this.sound.volume(Number(this.at("volume").value));
        this.calm = matchMedia("(prefers-reduced-motion: reduce)");
        this.paused = false;
        this.drawn = this.told = this.said = -Infinity;
        root.classList.toggle("single", all.length === 1);
        all.forEach((facts, i) => this.listed(facts, i));
        this.coloured();
        matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.coloured());
        this.controls();
        this.hands();
    }

    listed(facts, i) {
        const button = made("button", facts.name, { type: "button", "aria-pressed": "false" });
        button.append(made("small", facts.outcome));
        button.addEventListener("click", () => this.choose(i));
        this.at("loops").append(button);
    }

    coloured() {
        const style = getComputedStyle(document.documentElement);
        const names = ["ground", "ink", "soft", "faint", "wall", "force", "hand", "good", "bad", "loss"];
        this.colours = Object.fromEntries(names.map((name) => [name, style.getPropertyValue(`--${name}`).trim()]));
    }

    /* Play this loop, from its beginning. */
    choose(i) {
        const facts = this.all[i];
        this.facts = facts;
        this.player = new Player(facts, this.plant, this.laws[i]);
        this.full = loud(facts);
        this.profile = profile(facts, this.laws[i], PLACES * Math.ceil(facts.reach / Math.PI));
        this.again();
        [...this.at("loops").children].forEach((b, k) => b.setAttribute("aria-pressed", String(k === i)));
        for (const key of ["name", "outcome", "claim", "do", "notice"]) this.at(key).textContent = facts[key];
        for (const who of this.root.querySelectorAll(".who")) who.textContent = facts.arms.length > 1 ? "Hand and spring" : "The hand";
        this.at("stage").classList.toggle("turns", facts.thing !== "handle");
        this.at("outcome").style.background = facts.colour;
        this.at("numbers").replaceChildren(...facts.numbers.map(numbers));
        this.at("assumptions").replaceChildren(...facts.assumptions.map((line) => made("li", line)));
        this.at("stage").setAttribute("aria-label", `The hand on the ${facts.thing}`);
        this.at("described").textContent = `${facts.do} ${facts.notice}`;
    }

    again() {
        this.player.restart();
        this.waveform = new Waveform(this.sound.rate, this.player.engine.period, this.full);
        this.gripped();
    }

    frame(now) {
        const seconds = (now - (this.before ?? now)) / 1000;
        this.before = now;
        if (!this.paused) {
            const heard = this.sound.on ? (force) => this.waveform.push(force) : () => {};
            this.player.advance(seconds, heard, () => performance.now());
            this.sound.play(this.waveform.take());
        }
        if (!this.calm.matches || now - this.drawn > 100) this.pictures(now);
        if (now - this.told > TOLD_EVERY_MS) this.words(now);
        requestAnimationFrame((later) => this.frame(later));
    }

    pictures(now) {
        const { player, facts, colours } = this, { engine } = player, { history } = player;
        const names = engine.arms.length > 1 ? ["leader", "follower"] : [""];
        stage(this.at("stage"), {
            reach: facts.reach, thing: facts.thing, oneSided: facts.one_sided, full: this.full,
            names: [this.names.position, this.names.force],
            profile: this.profile, anchor: engine.pointer, held: engine.held, mark: (x) => this.length(x, 0),
            arms: engine.arms.map(({ position, force }, i) => ({ position, force, name: names[i], told: [this.length(position, 1), this.size(force)] })),
        }, colours);
        if (this.calm.matches && now - this.drawn < 500 && this.charted) return;
        this.drawn = now;
        this.charted = true;
        trace(this.at("force"), history, "force", (most) => `${this.names.force} of the last ${SECONDS} s, up to ${this.size(most)}`, colours.force, colours);
        trace(this.at("position"), history, "position", (most) => `${this.names.position}, up to ${this.length(most, 1)}`, colours.hand, colours);
        energy(this.at("energy"), history, (high) => `energy put in by hand, taken by friction; up to ${joules(high)}`, colours);
    }

    /* Numbers in words, and now and then for those who listen to the page. */
    words(now) {
        this.told = now;
        const { player, facts } = this, { engine } = player, [arm] = engine.arms, sums = player.sums;
        for (const key of ["work", "out", "motor", "loss"]) this.at(key).textContent = joules(sums[key]);
        const told = `${facts.thing} at ${this.length(arm.position, 1)}, ${this.names.force} ${this.size(arm.force)}, ${engine.held ? "held" : "let go"}`;
        const stage = this.at("stage");
        stage.setAttribute("aria-valuenow", String(Math.round((100 * engine.pointer) / facts.reach)));
        stage.setAttribute("aria-valuetext", told);
        this.at("state").textContent = this.state();
        if (now - this.said < SAID_EVERY_MS || told === this.last) return;
        this.said = now;
        this.last = told;
        const swing = player.history.swing("force", 1);
        const shakes = swing > 0.02 * this.full ? ` The ${this.names.force} goes up and down by ${this.size(swing)}.` : "";
        this.at("live").textContent = `${told}.${shakes} The hand put in ${joules(sums.work)}, friction took ${joules(sums.loss)}.`;
    }

    state() {
        const { engine, recording, slow } = this.player;
        if (engine.lost) return "The motion has grown beyond all bounds: start again.";
        if (slow) return "This machine is too slow for the rate of the loop: it runs slower than it would.";
        const whole = recording.full ? " The recording is full: start again for a new one." : "";
        return `${Math.round(1 / engine.period)} samples a second, ${(engine.k * engine.period).toFixed(1)} s.${whole}`;
    }

    controls() {
        const pressed = (id, on) => this.at(id).setAttribute("aria-pressed", String(on));
        this.at("grip").addEventListener("click", () => this.grip(!this.player.engine.held));
        this.at("again").addEventListener("click", () => this.again());
        this.at("pause").addEventListener("click", () => pressed("pause", (this.paused = !this.paused)));
        this.at("volume").addEventListener("input", (e) => this.sound.volume(Number(e.target.value)));
        this.at("sound").addEventListener("click", async () => {
            await this.sound.turn(!this.sound.on);
            this.waveform = new Waveform(this.sound.rate, this.player.engine.period, this.full);
            pressed("sound", this.sound.on);
        });
        this.at("download").addEventListener("click", () => this.download());
    }

    /* The pointer is the hand; so are the arrow keys. */
    hands() {
        const stage = this.at("stage");
        const aim = (e) => {
            if (this.facts.motion === "rotary") this.turn(e);
            else this.player.aim(((2 * e.offsetX) / stage.clientWidth - 1) * this.facts.reach);
        };
        stage.addEventListener("pointerdown", (e) => {
            stage.setPointerCapture(e.pointerId);
            this.grip(true);
            this.angle = undefined;
            aim(e);
        });
        stage.addEventListener("pointermove", (e) => stage.hasPointerCapture(e.pointerId) && aim(e));
        for (const end of ["pointerup", "pointercancel"]) stage.addEventListener(end, () => this.grip(false));
        stage.addEventListener("keydown", (e) => this.key(e));
    }

    /* By what the pointer went round the middle, also more than once; taken anywhere, it stays where it is. */
    turn({ offsetX, offsetY }) {
        const { clientWidth, clientHeight } = this.at("stage");
        const { x, y, r } = dial(0, this.facts.arms.length, clientWidth, clientHeight);
        if (Math.hypot(offsetX - x, offsetY - y) < 0.2 * r) return;
        const angle = Math.atan2(offsetX - x, y - offsetY), went = angle - (this.angle ?? angle);
        this.angle = angle;
        this.player.aim(this.player.target + went - 2 * Math.PI * Math.round(went / (2 * Math.PI)));
    }

    key(e) {
        const way = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1 }[e.key];
        if (way === undefined && e.key !== " ") return;
        e.preventDefault();
        const { engine } = this.player;
        if (way === undefined) return this.grip(!engine.held);
        if (!engine.held) this.grip(true);
        this.player.aim(this.player.target + way * STEP * (e.shiftKey ? 0.2 : 1) * this.facts.reach);
    }

    grip(held) {
        this.player.grip(held);
        this.gripped();
    }

    gripped() {
        const { held } = this.player.engine;
        this.at("grip").setAttribute("aria-pressed", String(held));
    }

    download() {
        const address = URL.createObjectURL(new Blob([this.player.recording.csv()], { type: "text/csv" }));
        const link = made("a", "", { href: address, download: "played.csv" });
        link.click();
        setTimeout(() => URL.revokeObjectURL(address), 10000);
    }

    /* What position and force are called. */
    get names() {
        return this.facts.motion === "rotary" ? { position: "angle", force: "torque" } : { position: "position", force: "force" };
    }

    length(x, digits) {
        return this.facts.motion === "rotary" ? `${fixed((x * 180) / Math.PI, digits)}°` : `${fixed(x * 1000, digits)} mm`;
    }

    size(force) {
        const milli = this.full < 0.5;
        return `${fixed(milli ? 1000 * force : force, milli ? 1 : 2)} ${milli ? "m" : ""}${this.facts.force_unit}`;
    }
}

function joules(energy) {
    const milli = energy * 1000;
    return Math.abs(milli) < 1000 ? `${fixed(milli, 2)} mJ` : `${fixed(energy, 2)} J`;
}

/* A number with a minus that is one, and none before 0. */
function fixed(value, digits) {
    const text = value.toFixed(digits);
    return Number(text) === 0 ? text.replace("-", "") : text.replace("-", "\u2212");
}

function numbers([symbol, name, value]) {
    const row = made("tr", "");
    row.append(made("th", name, { scope: "row" }), made("td", symbol), made("td", value));
    return row;
}

function made(tag, text, attributes = {}) {
    const element = document.createElement(tag);
    element.textContent = text;
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    return element;
}
