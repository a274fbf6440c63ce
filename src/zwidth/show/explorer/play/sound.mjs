/* The actuator force as sound, as zwidth.loop.traces.sound has it: held as the actuator holds it, its mean over some
 * 50 ms taken away, so that a buzz is heard at once.  A low tone beside it is as loud as the force is large, so that
 * what is too slow for an ear, such as a wobble, swells and fades.
 */

const MEAN_S = 0.05;
const TONE_HZ = 110;
const TONE = 0.15;
const STEEP = 2.5;
const AHEAD_S = 0.06;

/* From forces, one in a period, to samples of sound, `rate` a second; `full` is a loud force. */
export class Waveform {
    constructor(rate, period, full) {
        this.rate = rate;
        this.period = period;
        this.full = full;
        this.mean = 0;
        this.size = 0;
        this.time = 0;
        this.due = 0;
        this.made = [];
    }

    push(force) {
        const slow = 1 / (MEAN_S * this.rate);
        this.due += this.period * this.rate;
        for (; this.due >= 1; this.due -= 1) {
            this.mean += (force - this.mean) * slow;
            this.size += (Math.abs(force) - this.size) * slow;
            this.time += 1;
            const rough = Math.tanh((STEEP * (force - this.mean)) / this.full);
            const tone = Math.sin((2 * Math.PI * TONE_HZ * this.time) / this.rate);
            this.made.push(0.7 * rough + TONE * tone * Math.tanh(this.size / this.full));
        }
    }

    take() {
        const made = Float32Array.from(this.made);
        this.made = [];
        return made;
    }
}

/* Plays what it is given, one piece after the other; silent until a person asks for it. */
export class Sound {
    constructor() {
        this.on = false;
        this.when = 0;
        this.pieces = 0;
    }

    get rate() {
        return this.context?.sampleRate ?? 48000;
    }

    async turn(on) {
        this.on = on;
        if (!on) return this.context?.suspend();
        if (!this.context) {
            this.context = new AudioContext();
            this.gain = this.context.createGain();
            this.gain.connect(this.context.destination);
        }
        this.volume(this.loudness);
        return this.context.resume();
    }

    volume(part) {
        this.loudness = part;
        if (this.gain) this.gain.gain.value = part * part;
    }

    play(samples) {
        if (!this.on || !samples.length || this.context.state !== "running") return;
        const buffer = this.context.createBuffer(1, samples.length, this.rate), now = this.context.currentTime;
        buffer.copyToChannel(samples, 0);
        if (this.when < now || this.when > now + 5 * AHEAD_S) this.when = now + AHEAD_S;
        const source = this.context.createBufferSource();
        source.buffer = buffer;
        source.connect(this.gain);
        source.start(this.when);
        this.when += samples.length / this.rate;
        this.pieces += 1;
    }
}
