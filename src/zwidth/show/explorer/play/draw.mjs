/* The pictures: a handle, a wheel or a knob with hand and wall, or two of them; and what was in the last seconds. */

export const SECONDS = 8;
const BINS = 320;

/* The last seconds, in bins: of each quantity the lowest, the highest and the last of its samples. */
export class History {
    constructor(period, names) {
        this.names = names;
        this.many = Math.max(1, Math.round(SECONDS / BINS / period));
        this.clear();
    }

    clear() {
        this.bins = [];
        this.inside = 0;
    }

    push(values) {
        if (this.inside === 0) {
            this.bins.push(values.map((v) => [v, v, v]));
            if (this.bins.length > BINS) this.bins.shift();
        }
        const bin = this.bins[this.bins.length - 1];
        values.forEach((v, i) => {
            const own = bin[i];
            if (v < own[0]) own[0] = v;
            if (v > own[1]) own[1] = v;
            own[2] = v;
        });
        this.inside = (this.inside + 1) % this.many;
    }

    /* Half of what a quantity went up and down in the last part of a second. */
    swing(name, seconds) {
        const i = this.names.indexOf(name), last = this.bins.slice(-Math.ceil((BINS * seconds) / SECONDS));
        return last.length ? (Math.max(...last.map((b) => b[i][1])) - Math.min(...last.map((b) => b[i][0]))) / 2 : 0;
    }
}

/* A canvas as large as its place, in its own pixels; returns what draws and its size. */
export function fitted(canvas) {
    const ratio = globalThis.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
    if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
        canvas.width = Math.round(width * ratio);
        canvas.height = Math.round(height * ratio);
    }
    const pen = canvas.getContext("2d");
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, width, height);
    pen.font = "12px system-ui, sans-serif";
    return { pen, width, height };
}

/* Where a position stands on a stage of this width. */
export function across(position, reach, width) {
    return width / 2 + (position / reach) * (width / 2);
}

/* Handles that slide, or that turn; the law's force as a shade, and the hand. */
export function stage(canvas, look, colours) {
    const { pen, width, height } = fitted(canvas);
    (look.thing === "handle" ? slides : turns)(pen, look, width, height, colours);
}

function slides(pen, look, width, height, colours) {
    const place = (x) => across(x, look.reach, width);
    shade(pen, look, width, height, colours);
    const lane = height / (look.arms.length + 1);
    look.arms.forEach((arm, i) => {
        const y = lane * (i + 1);
        line(pen, [[0, y], [width, y]], colours.faint, 1);
        text(pen, `${arm.name} ${arm.told.join(", ")}`.trim(), 8, y - 8, colours.soft);
        handle(pen, place(arm.position), y, width, colours);
        push(pen, place(arm.position), y, arm.force / look.full, colours);
        if (i === 0) hand(pen, place(look.anchor), place(arm.position), y, look.held, colours);
    });
    ruler(pen, look, width, height, colours);
}

function shade(pen, look, width, height, colours) {
    const most = strongest(look);
    look.profile.forEach((force, i) => {
        pen.globalAlpha = Math.min(0.45, (0.45 * Math.abs(force)) / most);
        column(pen, i, look.profile.length, width, 0, height, colours.wall);
    });
    pen.globalAlpha = 1;
    if (look.oneSided) line(pen, [[width / 2, 0], [width / 2, height]], colours.wall, 3);
}

function strongest({ full, profile }) {
    return Math.min(full, Math.max(1e-12, ...profile.map(Math.abs)));
}

function handle(pen, x, y, width, colours) {
    const inside = Math.min(width - 10, Math.max(10, x));
    pen.fillStyle = colours.ink;
    pen.beginPath();
    if (inside === x) pen.roundRect(x - 9, y - 16, 18, 32, 5);
    else {
        const side = x > inside ? 1 : -1;
        pen.moveTo(inside + 8 * side, y);
        pen.lineTo(inside - 8 * side, y - 9);
        pen.lineTo(inside - 8 * side, y + 9);
    }
    pen.fill();
}

/* The actuator's force on the handle, an arrow; positive out of the wall. */
function push(pen, x, y, part, colours) {
    const long = -Math.max(-1, Math.min(1, part)) * 90, tip = x + long, back = Math.sign(long) * -6;
    if (Math.abs(long) < 1) return;
    line(pen, [[x, y + 24], [tip, y + 24]], colours.force, 4);
    line(pen, [[tip + back, y + 18], [tip, y + 24], [tip + back, y + 30]], colours.force, 4);
}

function hand(pen, anchor, x, y, held, colours) {
    const top = y - 34;
    if (held) {
        const points = [[anchor, top]];
        for (let i = 1; i < 12; i += 1) points.push([anchor + ((x - anchor) * i) / 12, top + 18 * (i / 12) + (i % 2 ? 4 : -4)]);
        line(pen, [...points, [x, y - 16]], colours.hand, 2);
    }
    disc(pen, [held ? anchor : x, top], 8, held ? colours.hand : "transparent", colours.hand);
}

const RING = 14, ROOM = 48;

/* Where the i-th of so many wheels or knobs is: its middle and its rim. */
export function dial(i, many, width, height) {
    const x = (width * (i + 0.5)) / many, y = height / 2 + 8;
    return { x, y, r: Math.max(24, Math.min(height / 2 - ROOM, width / (2 * many) - ROOM)) };
}

/* Angle 0 is up, and positive to the right; of the law half a turn to either side of where the handle is. */
function turns(pen, look, width, height, colours) {
    look.arms.forEach((arm, i) => {
        const { x, y, r } = dial(i, look.arms.length, width, height), turn = arm.position;
        const at = (angle, radius) => [x + radius * Math.sin(angle), y - radius * Math.cos(angle)];
        const arc = (from, to, radius, many = 72) => Array.from({ length: many + 1 }, (_, k) => at(from + ((to - from) * k) / many, radius));
        ring(pen, look, turn, arc, at, r, colours);
        if (look.thing === "wheel") {
            line(pen, arc(0, 2 * Math.PI, r), colours.ink, 9);
            for (const spoke of [1, 2]) line(pen, [[x, y], at(turn + (spoke * 2 * Math.PI) / 3, r)], colours.ink, 6);
            line(pen, [[x, y], at(turn, r)], colours.hand, 6);
        } else {
            disc(pen, [x, y], r, colours.ink, colours.ink);
            line(pen, [at(turn, 0.45 * r), at(turn, r)], colours.ground, 5);
        }
        const span = -Math.max(-1, Math.min(1, arm.force / look.full)) * 1.5, tip = turn + span, back = tip - Math.sign(span) * 0.16;
        if (Math.abs(span) > 0.02) {
            line(pen, arc(turn, tip, 0.62 * r), colours.force, 4);
            line(pen, [at(back, 0.62 * r - 7), at(tip, 0.62 * r), at(back, 0.62 * r + 7)], colours.force, 4);
        }
        if (i === 0) {
            const out = arc(turn, look.anchor, r + 7, 12);
            if (look.held) line(pen, arc(turn, look.anchor, r, 12).map((point, k) => (k % 2 ? out[k] : point)), colours.hand, 2);
            disc(pen, at(look.held ? look.anchor : turn, r), 9, look.held ? colours.hand : "transparent", colours.hand);
        }
        if (arm.name) middled(pen, `${arm.name} ${arm.told.join(", ")}`, x, height - 6, 13, colours.soft);
    });
    if (look.arms.length > 1) return;
    const beside = width / 2 - dial(0, 1, width, height).r > 200, y = beside ? height / 2 : 30;
    const size = Math.max(13, Math.min(28, width / 30));
    look.arms[0].told.forEach((value, i) => {
        const x = beside ? (width * (1 + 4 * i)) / 6 : [44, width - 44][i];
        middled(pen, look.names[i], x, y - size, 13, colours.soft);
        middled(pen, value, x, y + 2, size, colours.ink);
    });
}

/* The law's torque around the rim, where it begins, and angles. */
function ring(pen, look, turn, arc, at, r, colours) {
    const most = strongest(look), step = (2 * look.reach) / look.profile.length;
    const first = Math.max(-look.reach, turn - Math.PI), last = Math.min(look.reach, turn + Math.PI);
    line(pen, arc(first, last, r + RING), colours.faint, 1);
    look.profile.forEach((force, i) => {
        const from = i * step - look.reach;
        if (from < first || from + step > last) return;
        pen.globalAlpha = Math.min(0.7, (0.7 * Math.abs(force)) / most);
        line(pen, arc(from, from + step, r + RING, 1), colours.wall, RING);
    });
    pen.globalAlpha = 1;
    if (look.oneSided && Math.abs(turn) < Math.PI) line(pen, [at(0, r + 6), at(0, r + 8 + RING)], colours.wall, 3);
    const apart = Math.PI / (look.reach > Math.PI / 2 ? 2 : 6);
    for (let k = Math.ceil(first / apart); k * apart <= last; k += 1) {
        const angle = k * apart, [x, y] = at(angle, r + RING + 18 + 10 * Math.abs(Math.sin(angle)));
        if (Math.abs(angle - turn) < 2.5) middled(pen, look.mark(angle), x, y + 4, 12, colours.soft);
    }
}

function disc(pen, [x, y], r, fill, edge) {
    pen.fillStyle = fill;
    pen.strokeStyle = edge;
    pen.lineWidth = 2;
    pen.beginPath();
    pen.arc(x, y, r, 0, 2 * Math.PI);
    pen.fill();
    pen.stroke();
}

function middled(pen, words, x, y, size, colour) {
    pen.font = `${size}px system-ui, sans-serif`;
    pen.textAlign = "center";
    text(pen, words, x, y, colour);
}

function ruler(pen, look, width, height, colours) {
    for (const part of [-0.5, 0, 0.5]) {
        const x = across(part * look.reach, look.reach, width);
        line(pen, [[x, height - 6], [x, height]], colours.soft, 1);
        text(pen, look.mark(part * look.reach), x + 4, height - 3, colours.soft);
    }
}

/* A quantity of the last seconds: the band between its lowest and its highest, around 0. */
export function trace(canvas, history, name, label, colour, colours) {
    const { pen, width, height } = fitted(canvas), i = history.names.indexOf(name);
    const most = Math.max(1e-12, ...history.bins.map((b) => Math.max(-b[i][0], b[i][1]))) * 1.1;
    const y = (v) => height / 2 - (v / most) * (height / 2 - 8) + 8;
    line(pen, [[0, y(0)], [width, y(0)]], colours.faint, 1);
    history.bins.forEach((b, k) => {
        const before = history.bins[Math.max(0, k - 1)][i][2];
        const high = Math.max(b[i][1], before), low = Math.min(b[i][0], before);
        column(pen, k, BINS, width, y(high) - 0.75, y(low) + 0.75, colour);
    });
    text(pen, label(most / 1.1), 6, 14, colours.ink);
}

/* What the hand put in, filled, red below 0 where it got out more; and before it what friction took. */
export function energy(canvas, history, label, colours) {
    const { pen, width, height } = fitted(canvas);
    const [work, loss] = ["work", "loss"].map((name) => history.names.indexOf(name));
    const values = history.bins.flatMap((b) => [b[work][2], b[loss][2]]);
    const high = Math.max(1e-9, ...values) * 1.3, low = Math.min(0, ...values) * 1.15;
    const y = (v) => ((high - v) / (high - low)) * (height - 1);
    history.bins.forEach((b, k) => {
        column(pen, k, BINS, width, y(0), y(b[work][2]), b[work][2] < 0 ? colours.bad : colours.good);
        pen.globalAlpha = 0.75;
        column(pen, k, BINS, width, y(0), y(b[loss][2]), colours.loss);
        pen.globalAlpha = 1;
    });
    line(pen, [[0, y(0)], [width, y(0)]], colours.ink, 1);
    text(pen, label(high / 1.3), 6, 14, colours.ink);
}

/* The k-th of so many columns side by side, in whole pixels: without seams, and none over another. */
function column(pen, k, many, width, from, to, colour) {
    const left = Math.round((k * width) / many), right = Math.round(((k + 1) * width) / many);
    pen.fillStyle = colour;
    pen.fillRect(left, Math.min(from, to), right - left, Math.abs(to - from));
}

function line(pen, points, colour, wide) {
    pen.strokeStyle = colour;
    pen.lineWidth = wide;
    pen.beginPath();
    points.forEach(([x, y], i) => (i ? pen.lineTo(x, y) : pen.moveTo(x, y)));
    pen.stroke();
}

function text(pen, words, x, y, colour) {
    pen.fillStyle = colour;
    pen.fillText(words, x, y);
}
