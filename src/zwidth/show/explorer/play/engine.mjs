/* The loop, sample by sample, as zwidth.loop.kernel and zwidth.loop.pair.kernel run it: measure, compute, apply
 * after the delay, hold, move.  The plant and the laws are the modules that zwidth emits; with the same hand
 * every number here has the bits of `zwidth.simulate`.
 *
 * Nothing here knows a page: tests run it in node.
 */

const NOBODY = { mass: 0, stiffness: 0, damping: 0 };

/* One arm: its plant, what its encoder reads, and the commands that are still on their way. */
export class Arm {
    constructor(facts, plant) {
        this.facts = facts;
        this.plant = facts.two ? plant.two : plant;
        this.hand = facts.hand ?? NOBODY;
        this.restart();
    }

    restart() {
        this.s = this.plant.init(this.facts.start);
        this.commands = new Float64Array(this.facts.late + 1);
    }

    get position() {
        return this.s.state[this.plant.POSITION];
    }

    /* Where the encoder is: on the handle, or at a motor behind a transmission. */
    get sensed() {
        const { two } = this.facts;
        return two && !two.at_handle ? this.s.state[this.plant.MOTOR] : this.position;
    }

    get velocity() {
        return this.s.state[this.plant.VELOCITY];
    }

    get force() {
        return this.s.state[this.plant.FORCE];
    }

    /* What the hand put in, what the actuator put in, what friction took [J]. */
    get energies() {
        const { state } = this.s, { HAND_WORK, ACTUATOR_WORK, VISCOUS, COULOMB, INSIDE_LOSS } = this.plant;
        const inside = this.facts.two ? state[INSIDE_LOSS] : 0;
        return [state[HAND_WORK], state[ACTUATOR_WORK], state[VISCOUS] + state[COULOMB] + inside];
    }

    get counts() {
        return Math.floor(this.sensed / this.facts.resolution + 0);
    }

    /* The reading [m; rad]. */
    get reading() {
        return this.facts.resolution > 0 ? this.facts.resolution * this.counts : this.sensed;
    }

    push(force) {
        this.s.state[this.plant.FORCE] = force;
        this.s.state[this.plant.GOAL] = force;
    }

    /* Sample k gives this command; the one that is due by now acts, unless it is due within the interval. */
    command(k, force) {
        const { late, offset } = this.facts;
        this.commands[k % (late + 1)] = force;
        if (k >= late && offset === 0) this.push(this.commands[(k - late) % (late + 1)]);
    }

    /* Through interval k, the anchor of the hand going from here at this speed. */
    move(k, hand, anchor, speed) {
        const { late, offset, period } = this.facts;
        if (offset === 0 || k < late) {
            this.advance(hand, anchor, speed, period);
            return;
        }
        this.advance(hand, anchor, speed, offset);
        this.push(this.commands[(k - late) % (late + 1)]);
        this.advance(hand, anchor + speed * offset, speed, period - offset);
    }

    advance(hand, anchor, speed, time) {
        const { plant: p, two } = this.facts, held = [hand.stiffness, hand.damping];
        const moved = two
            ? [p.mass, p.damping, p.coulomb, p.stiction, two.mass, hand.mass, two.damping, two.coulomb, two.stiction,
                ...held, two.spring, two.damper]
            : [p.mass, hand.mass, p.damping, p.coulomb, p.stiction, ...held];
        this.plant.step(this.s, ...moved, this.force, 0, anchor, speed, time);
    }
}

/* The law of one device, as emitted. */
class SingleLaw {
    constructor(arm, law) {
        this.arm = arm;
        this.law = law;
        this.restart();
    }

    get seen() {
        return this.arm.facts.resolution > 0 ? this.arm.counts : this.arm.sensed;
    }

    restart() {
        this.memory = this.law.init(this.seen);
    }

    step(k) {
        this.arm.command(k, this.law.step(this.memory, this.seen));
    }
}

/* What joins two arms: a spring and a damper between readings, those of the other as old as the link makes them. */
class PairLaw {
    constructor(arms, often) {
        this.arms = arms;
        this.often = often;
        this.restart();
    }

    restart() {
        this.sides = this.arms.map((arm) => {
            const { law } = arm.facts, length = Math.max(law.age, law.echo_age) + 2;
            return { law, newest: arm.reading, before: arm.reading, told: 0, sent: new Float64Array(length).fill(arm.reading) };
        });
        this.settle();
    }

    /* The force as it was before the start: both arms had always been where they are. */
    settle() {
        this.sides.forEach(({ law, newest }, i) => {
            let f = (law.own + law.own_before + law.echo + law.echo_before) * newest;
            f += (law.heard + law.heard_before) * this.sides[1 - i].newest;
            this.arms[i].push(converted(law, f));
        });
    }

    step(k) {
        this.sides.forEach((side, i) => {
            if (k % side.law.every !== 0) return;
            side.before = k === 0 ? this.arms[i].reading : side.newest;
            side.newest = this.arms[i].reading;
        });
        if (k % this.often === 0) this.exchange(k / this.often);
        this.sides.forEach(({ law, newest, before, told }, i) => {
            this.arms[i].command(k, converted(law, law.own * newest + law.own_before * before + told));
        });
    }

    exchange(j) {
        for (const side of this.sides) side.sent[j % side.sent.length] = side.newest;
        this.sides.forEach((side, i) => {
            const { law } = side, other = this.sides[1 - i];
            let told = law.heard * old(other, j - law.age) + law.heard_before * old(other, j - law.age - 1);
            told += law.echo * old(side, j - law.echo_age) + law.echo_before * old(side, j - law.echo_age - 1);
            side.told = told;
        });
    }
}

/* What was sent in sample j; before the first one the arm was where it is at the first. */
function old({ sent }, j) {
    return sent[Math.max(j, 0) % sent.length];
}

/* In steps of the converter and up to the limit. */
function converted({ step, limit }, force) {
    const f = step > 0 ? step * Math.floor(force / step + 0.5) : force;
    return limit > 0 && Math.abs(f) > limit ? (f > 0 ? limit : -limit) : f;
}

/* A hand on the first arm: held, its anchor goes from pointer to pointer; let go, it is nobody's. */
export class Engine {
    constructor(facts, plant, law) {
        this.facts = facts;
        this.period = facts.arms[0].period;
        this.arms = facts.arms.map((arm) => new Arm(arm, plant));
        this.law = law ? new SingleLaw(this.arms[0], law) : new PairLaw(this.arms, facts.often);
        this.restart();
    }

    restart() {
        for (const arm of this.arms) arm.restart();
        this.law.restart();
        this.k = 0;
        this.held = true;
        this.pointer = this.arms[0].position;
    }

    /* Take the handle where it is, or leave it. */
    grip(held) {
        if (held && !this.held) this.pointer = this.arms[0].position;
        this.held = held;
    }

    /* True where the motion went beyond all bounds, or its instants could not be told apart. */
    get lost() {
        return this.arms.some((arm) => !(Math.abs(arm.position) < 1e6) || arm.s.state[arm.plant.FAULT] !== 0);
    }

    /* Sample k is taken, and its row noted; then everything moves to the next, the pointer to `pointer`. */
    step(pointer, note) {
        const k = this.k, here = this.pointer;
        this.law.step(k);
        note?.(this);
        const speed = (pointer - here) / this.period;
        this.arms.forEach((arm, i) => {
            const holding = i > 0 || this.held, anchor = i > 0 ? arm.facts.start : here;
            arm.move(k, holding ? arm.hand : NOBODY, holding ? anchor : 0, holding && i === 0 ? speed : 0);
        });
        this.pointer = pointer;
        this.k = k + 1;
    }
}
