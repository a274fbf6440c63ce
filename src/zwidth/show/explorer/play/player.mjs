/* A loop in time with a clock: as many samples as have become due, the hand on its way to where it is asked to. */

import { Engine } from "./engine.mjs";
import { History } from "./draw.mjs";
import { Recording } from "./recording.mjs";

const LONGEST_S = 0.1;
/* Of a pause, such as that of a hidden page: the rest of it has not been. */

const FASTEST = 25;
/* Of the hand, in reaches a second: a pointer may jump, a hand cannot. */

const BUDGET_MS = 25;
const RECORDED_S = 120;

export class Player {
    constructor(facts, plant, law) {
        this.facts = facts;
        this.engine = new Engine(facts, plant, law);
        this.recording = new Recording(facts, Math.min(300000, Math.ceil(RECORDED_S / this.engine.period)));
        this.history = new History(this.engine.period, ["force", "position", "work", "loss"]);
        this.restart();
    }

    restart() {
        this.engine.restart();
        this.recording.clear();
        this.history.clear();
        this.target = this.engine.pointer;
        this.owed = 0;
        this.most = 0;
        this.slow = false;
    }

    /* Take the handle where it is, or let it go. */
    grip(held) {
        this.engine.grip(held);
        this.target = this.engine.pointer;
    }

    aim(position) {
        const { reach } = this.facts;
        this.target = Math.min(reach, Math.max(-reach, position));
    }

    /* Go on by the seconds that have passed; every force is told to `hear`. */
    advance(seconds, hear, now = () => 0) {
        const { engine } = this, { period } = engine;
        this.owed += Math.min(seconds, LONGEST_S);
        const due = Math.floor(this.owed / period), from = engine.pointer, began = now();
        const way = FASTEST * this.facts.reach * due * period;
        const to = from + Math.min(way, Math.max(-way, this.target - from));
        this.slow = false;
        for (let i = 1; i <= due && !engine.lost; i += 1) {
            engine.step(from + ((to - from) * i) / due, (e) => this.note(e, hear));
            if (i % 64 === 0 && now() - began > BUDGET_MS) {
                this.slow = true;
                break;
            }
        }
        this.owed -= due * period;
    }

    note(engine, hear) {
        const [arm] = engine.arms, { work, loss } = this.sums;
        this.recording.note(engine);
        this.history.push([arm.force, arm.position, work, loss]);
        this.most = Math.max(this.most, -work);
        hear(arm.force);
    }

    /* Put in by hands, got out by them at most, put in by actuators, taken by friction [J]; of all arms. */
    get sums() {
        let work = 0, motor = 0, loss = 0;
        for (const arm of this.engine.arms) {
            const own = arm.energies;
            work += own[0];
            motor += own[1];
            loss += own[2];
        }
        return { work, motor, loss, out: this.most };
    }
}

/* The law's force at rest at places from −reach to reach, none for two arms; its memory is its own. */
export function profile(facts, law, places) {
    if (!law) return [];
    const { resolution } = facts.arms[0];
    return Array.from({ length: places }, (_, i) => {
        const x = facts.reach * ((2 * (i + 0.5)) / places - 1), seen = resolution > 0 ? Math.floor(x / resolution) : x;
        return law.step(law.init(seen), seen);
    });
}

/* A loud force [N; N·m]: what the hand can press with, or the actuator give. */
export function loud(facts) {
    const { hand, limit } = facts.arms[0], pressed = 0.5 * hand.stiffness * Math.min(facts.reach, 1);
    return limit > 0 ? Math.min(limit, pressed) : pressed;
}
