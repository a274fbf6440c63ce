/* What was done and what came of it, sample by sample, until it is full. */
export class Recording {
    constructor(facts, most) {
        this.columns = columnsOf(facts);
        this.period = facts.arms[0].period;
        this.most = most;
        this.rows = [];
    }

    clear() {
        this.rows = [];
    }

    get full() {
        return this.rows.length >= this.most;
    }

    note(engine) {
        if (this.full) return;
        const row = [engine.k * this.period, engine.pointer, Number(engine.held)];
        for (const arm of engine.arms) row.push(arm.position, arm.velocity, arm.force, ...arm.energies);
        this.rows.push(row);
    }

    csv() {
        return [this.columns, ...this.rows].map((row) => row.join(",")).join("\n") + "\n";
    }
}

function columnsOf({ keys, arms }) {
    const names = ["time_s", `pointer_${keys.position}`, "held"];
    for (const prefix of arms.length > 1 ? ["leader_", "follower_"] : [""]) {
        names.push(`${prefix}position_${keys.position}`, `${prefix}velocity_${keys.velocity}`);
        names.push(`${prefix}force_${keys.force}`);
        names.push(...["hand_work", "actuator_work", "friction_loss"].map((name) => `${prefix}${name}_J`));
    }
    return names;
}
