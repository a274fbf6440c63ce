/* Motions of a hand that tries to take energy out: drawn from families, run, the best improved.

   What a law, a row of laws and a score are, is told in motions.py and rows.py; the numbers stand in
   `law` and `row` in the order of the names there. */
#include <math.h>
#include <stdint.h>
#include <string.h>

enum { GATE, CLAMPED, COUNTED, PHASE, FRICTION, DRAG, WHOLE, PART, KEPT, STORED, ANGLE, POLE, STATIC };
enum { BOTH, POSITION, PENETRATION };
enum { FAMILIES = 8 };
static const double PI = 3.14159265358979323846;

/* draws: splitmix64 */
typedef struct { uint64_t at; } Draws;
static double drawn(Draws *d) {
    uint64_t z = (d->at += UINT64_C(0x9E3779B97F4A7C15));
    z = (z ^ (z >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94D049BB133111EB);
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}
static int below(Draws *d, double end) { return (int)(drawn(d) * end); }
static double normal(Draws *d) {
    double far = sqrt(-2.0 * log(1.0 - drawn(d)));
    return far * cos(2.0 * PI * drawn(d));
}

/* (taken out, lost) over a sample in which the force changes, the hand at its best when it does */
static double within(double early, double late, double moved, double part, double fc, double drag, double *took) {
    double best = -1e300, lean = drag > 0.0 ? part * (1.0 - part) / (2.0 * drag) : 0.0;
    for (int way = 0; way < 5; way++) {
        double u = way == 0 ? 0.0 : way == 1 ? moved : part * moved - lean * (early - late + (way - 3) * 2.0 * fc);
        double v = moved - u;
        double lost = fc * (fabs(u) + fabs(v)) + drag * (u * u / part + v * v / (1.0 - part));
        double value = -early * u - late * v - lost;
        if (value > best) { best = value; *took = lost; }
    }
    return best;
}

/* Energy taken out and lost up to each sample; `memory` and `line` are scratch. */
static void run(const double *law, const double *num, const double *den, int order, const double *x, int n,
                double *energy, double *loss, double *memory, double *line) {
    int whole = (int)law[WHOLE];
    double part = law[PART], fc = law[FRICTION], drag = law[DRAG], out = 0.0, lost = 0.0, first = 0.0;
    memset(memory, 0, (size_t)(order + 2) * sizeof *memory);
    memset(line, 0, (size_t)(whole + 2) * sizeof *line);
    energy[0] = loss[0] = 0.0;
    for (int k = 0; k < n - 1; k++) {
        double q = law[COUNTED] > 0.0 ? floor(x[k] + law[PHASE]) + law[PHASE] : x[k];
        double u = law[GATE] == PENETRATION ? fmax(q, 0.0) : q;
        if (k == 0) first = u; /* where the law has been at rest for ever */
        u -= first;
        double f = num[0] * u + memory[0];
        for (int i = 1; i <= order; i++) memory[i - 1] = memory[i] + num[i] * u - den[i] * f;
        f += law[STATIC] * first;
        if (law[GATE] != BOTH && q <= 0.0) f = 0.0;
        if (law[CLAMPED] > 0.0) f = fmax(f, 0.0);
        for (int i = whole + 1; i > 0; i--) line[i] = line[i - 1];
        line[0] = f;
        double moved = x[k + 1] - x[k], took = 0.0;
        if (part == 0.0) {
            took = fc * fabs(moved) + drag * moved * moved;
            out -= line[whole] * moved + took;
        } else {
            out += within(line[whole + 1], line[whole], moved, part, fc, drag, &took);
        }
        lost += took + 1e-16 * fabs(line[whole] * moved);
        energy[k + 1] = out;
        loss[k + 1] = lost;
    }
}

/* What was taken out beyond what was stored over what was lost, at best; and the sample where. */
static double scored(const double *law, const double *x, int n, int period, const double *energy,
                     const double *loss, int *at) {
    double best = -1e300;
    *at = n - 1;
    for (int k = 2; k < n; k++) {
        double value = loss[k] > 0.0 ? (energy[k] - law[STORED]) / loss[k] : -1e300;
        if (value > best) { best = value; *at = k; }
    }
    if (period > 0 && n > 3 * period && x[n - 1] == x[n - 1 - period]) {
        double lost = loss[n - 1] - loss[n - 1 - period], gain = energy[n - 1] - energy[n - 1 - period];
        double before = energy[n - 1 - period] - energy[n - 1 - 2 * period];
        if (lost > 0.0 && fabs(gain - before) <= 0.001 * fabs(gain) && gain / lost > best) { /* settled */
            best = gain / lost;
            *at = n - 1;
        }
    }
    return best;
}

/* Begin at rest; a motion that has to stay inside is carried there. */
static void inside(const double *law, double *x, int n) {
    int counted = law[COUNTED] > 0.0;
    if (law[GATE] == BOTH) {
        x[0] = 0.0;
    } else if (law[KEPT] > 0.0) {
        double lowest = 1e300, least = counted ? 1.0 : 1e-9;
        for (int k = 1; k < n; k++) lowest = fmin(lowest, x[k]);
        if (lowest < least) {
            double shift = counted ? ceil(least - lowest) : least - lowest;
            for (int k = 1; k < n; k++) x[k] = counted ? x[k] + shift : fmax(x[k] + shift, least);
        }
        x[0] = 0.0;
    } else if (law[PHASE] > 0.0) {
        x[0] = fmin(x[0], -2.0); /* the position is x + 2 phases: a reading of 0 may lie a count inside */
    } else {
        x[0] = fmin(x[0], counted ? -1.0 : 0.0);
    }
}

/* A step: part of a count, counts, or anything over decades. */
static double size_of(Draws *d, const double *law) {
    double kind = drawn(d);
    if (law[COUNTED] > 0.0) {
        if (kind < 0.35) return pow(10.0, -7.0 * drawn(d));
        if (kind < 0.7) return 1.0 + floor(8.0 * drawn(d));
        return pow(10.0, 6.0 * drawn(d));
    }
    return law[FRICTION] > 0.0 ? pow(10.0, 7.0 * drawn(d) - 2.0) : 1.0;
}

/* How deep a motion goes on: near the surface, some counts, or much deeper than its step. */
static double depth(Draws *d, const double *law, double step) {
    double kind = drawn(d);
    if (kind < 0.3) return 0.0;
    if (kind < 0.7) return law[COUNTED] > 0.0 ? floor(10.0 * drawn(d)) : step * 3.0 * drawn(d);
    return step * pow(10.0, 3.0 * drawn(d));
}

/* A motion of a family; returns the samples of a round that it ends with, 0 for none. */
static int draw(Draws *d, const double *law, int family, double *x, int n) {
    double step = size_of(d, law), deep = depth(d, law, step);
    int counted = law[COUNTED] > 0.0, late = (int)law[WHOLE] + (law[PART] > 0.0);
    memset(x, 0, (size_t)n * sizeof *x);
    if (family == 0) { /* in and out, each way for some samples */
        int hold = 1 + below(d, 1.5 + late), away = 1 + below(d, 1.5 + late);
        double low = drawn(d) < 0.7 ? deep : deep - step * drawn(d);
        for (int k = 1; k < n; k++) x[k] = (k - 1) % (hold + away) < hold ? low + step : low;
        return hold + away;
    }
    if (family == 1) { /* a sinusoid where the criterion is tightest, inside or through the surface */
        double angle = drawn(d) < 0.7 ? law[ANGLE] : PI * drawn(d);
        double middle = drawn(d) < 0.6 ? deep + step : step * (2.0 * drawn(d) - 1.0);
        double phase = 2.0 * PI * drawn(d);
        for (int k = 1; k < n; k++) x[k] = middle + step * cos(angle * k + phase);
        return 0;
    }
    if (family == 2) { /* to and fro over one edge, with waits */
        int hold = 1 + late + (int)(3.0 * pow(drawn(d), 2)), away = 1 + late + (int)(3.0 * pow(drawn(d), 2));
        double edge = (counted ? 1.0 + floor(6.0 * drawn(d)) : 0.0) - law[PHASE];
        double tiny = counted ? pow(10.0, -7.0 * drawn(d)) : step;
        int lead = n / 3 < 24 ? n / 3 : 24;
        for (int k = 1; k < n; k++) {
            int turn = k - lead; /* whether the edge is crossed is asked behind the lead alone */
            x[k] = k < lead ? (edge - tiny) * k / lead : turn % (hold + away) < hold ? edge : edge - tiny;
        }
        return hold + away;
    }
    if (family == 3) { /* a run-up that grows like the law forgets, a touch, and away */
        double rate = law[POLE] > 0.0 && drawn(d) < 0.7 ? 1.0 / law[POLE] : 1.0 + 2.0 * pow(drawn(d), 3);
        rate = 1.0 + (rate - 1.0) * (0.5 + drawn(d));
        int span = 1 + below(d, n - 4);
        double total = 0.0;
        for (int k = span; k > 0; k--) {
            x[k] = -total;
            total += step * pow(rate, k - span);
        }
        x[0] = -total;
        double touch = pow(10.0, -8.0 * drawn(d)) * step;
        if (counted) touch = 1.0 - law[PHASE];
        for (int k = 0; k <= span; k++) x[k] += touch;
        double back = step * pow(10.0, drawn(d) * 3.0 - 2.0);
        int turns = drawn(d) < 0.5;
        if (law[POLE] < 1.0) back /= 1.0 - law[POLE] * law[POLE];
        double decay = law[POLE] > 0.0 && drawn(d) < 0.7 ? law[POLE] : 0.5 + 0.5 * drawn(d);
        for (int k = span + 1; k < n; k++) {
            x[k] = (k - span) % 2 == 1 || !turns ? touch - back : touch;
            back *= turns ? decay : 1.0;
        }
        return 0;
    }
    if (family == 4) { /* a walk on counts */
        double here = deep, tiny = pow(10.0, -6.0 * drawn(d));
        double unit = counted && drawn(d) < 0.7 ? 1.0 : step;
        for (int k = 1; k < n; k++) {
            here += unit * (floor(3.0 * drawn(d)) - 1.0);
            x[k] = here - (drawn(d) < 0.5 ? tiny : 0.0);
        }
        return 0;
    }
    if (family == 5) { /* press, slowly, wait, and let go at once, again and again */
        int rise = 1 + below(d, n / 3.0), wait = below(d, 8.0), off = 1 + below(d, 6.0);
        double out = drawn(d) < 0.5 ? 0.0 : -step * drawn(d);
        for (int k = 1; k < n; k++) {
            int turn = (k - 1) % (rise + wait + off);
            x[k] = turn < rise + wait ? step * (turn + 1 < rise ? turn + 1 : rise) / rise : out;
        }
        return 0;
    }
    if (family == 6) { /* a short pattern, again and again */
        int period = 2 + below(d, 6.0);
        for (int k = 1; k < n; k++)
            x[k] = k <= period ? deep + step * (floor(5.0 * drawn(d)) - 1.0) : x[k - period];
        return period;
    }
    double smooth = drawn(d), here = 0.0, speed = 0.0;
    for (int k = 1; k < n; k++) {
        speed = smooth * speed + step * normal(d);
        here += speed;
        x[k] = here + deep;
    }
    return 0;
}

/* Change a motion a little; its rounds stay equal. */
static int change(Draws *d, const double *law, double *x, int n, int turn) {
    double scale = 0.0;
    for (int k = 1; k < n; k++) scale = fmax(scale, fabs(x[k] - x[k - 1]));
    int kind = below(d, 5.0);
    double shift = scale * normal(d);
    shift *= pow(10.0, -4.0 * drawn(d));
    if (law[COUNTED] > 0.0 && drawn(d) < 0.3) shift = drawn(d) < 0.5 ? 1.0 : -1.0;
    int k = 1 + below(d, n - 1), end = n;
    if (turn > 0 && kind < 3) {
        for (int i = k % turn; i < n; i += turn)
            if (i > 0) x[i] += shift;
        return turn;
    }
    if (kind == 3) {
        double factor = 1.0 + 0.3 * normal(d) * drawn(d);
        for (int i = 0; i < n; i++) x[i] *= factor;
        return turn;
    }
    if (kind == 4) k = 0;
    if (kind == 0) end = k + 1;
    if (kind == 2) end = k + 1 + below(d, n - k);
    for (int i = k; i < end && i < n; i++) x[i] += shift;
    return kind == 4 ? turn : 0;
}

/* A law alone: its score; the best motion, its length and the samples of its last round.
   `room`: 3 n + order + 2 + WHOLE + 2 numbers. */
double search(uint64_t seed, const double *law, const double *num, const double *den, int order, int n,
              int motions, int climbs, double *best, int *length, int *turn, double *room) {
    Draws d = {seed};
    double *trial = room, *energy = room + n, *loss = room + 2 * n, *memory = room + 3 * n;
    double *line = memory + order + 2, score = -1e300;
    int last = 0;
    *turn = 0;
    for (int k = 0; k < motions + climbs; k++) {
        int period, end;
        if (k < motions) {
            period = draw(&d, law, k % FAMILIES, trial, n);
        } else {
            memcpy(trial, best, (size_t)n * sizeof *trial);
            period = change(&d, law, trial, n, *turn);
        }
        inside(law, trial, n);
        run(law, num, den, order, trial, n, energy, loss, memory, line);
        double found = scored(law, trial, n, period, energy, loss, &end);
        if (found > score) {
            score = found, *turn = period, last = end;
            memcpy(best, trial, (size_t)n * sizeof *best);
        }
    }
    *length = last + 1;
    if (last != n - 1) *turn = 0;
    return score;
}

/* Rows of laws. */
enum { WALL, AHEAD, SATURATED, LAW, STEP, RESETS, SAMPLES, SLOPE, COUNT, CREDITED };
enum { BOUNDING, ENERGY, LEAP, LOCAL };
static double clipped(double f, double room) { return fmin(fmax(f, -room), room); }

/* The largest force of force bounding after a move, as its docstring has it; E and g move on. */
static double bounded(double *energy, double *slope, double held, double moved, double p, double friction,
                      double size) {
    double low = held - friction, high = held + friction;
    if (moved != 0.0) {
        double middle = held + 2.0 * p * moved + (moved > 0.0 ? friction : -friction);
        low = middle - p * size, high = middle + p * size;
    }
    double next = fmin(fmax(*slope, low), high), beyond = fmax(fabs(next - held) - friction, 0.0);
    *energy += next * moved - beyond * beyond / (4.0 * p) - fabs(next - *slope) * size / 2.0;
    double spare = *energy - fabs(next) * size / 2.0;
    if (spare < 0.0) *energy = next = spare = 0.0;
    *slope = next;
    return friction + 2.0 * sqrt(p * spare);
}

/* The force of each sample, as the row of laws gives it. */
void forces(const double *law, const double *row, const double *x, int n, double *force) {
    int counted = row[COUNT] > 0.0;
    double p = law[DRAG], energy = 0.0, slope = 0.0, left = 0.0, reference = 0.0, base = 0.0, off = 1.0;
    double spare = 0.0, held = 0.0, before = 0.0, half = row[STEP] / 2.0;
    for (int k = 0; k < n; k++) {
        double q = counted ? floor(x[k]) : x[k], f;
        if (k == 0) before = reference = q;
        double moved = q - before, seen = q + row[AHEAD] * moved;
        double wish = seen > 0.0 ? row[WALL] * seen : 0.0;
        if (row[SATURATED] > 0.0) wish = clipped(wish, row[SATURATED]);
        if (row[LAW] == BOUNDING) {
            if (row[RESETS] > 0.0 && held == 0.0) energy = slope = 0.0;
            double size = counted && row[SAMPLES] > 0.0 ? 1.0 : 0.0;
            double room = bounded(&energy, &slope, held, moved, p, row[CREDITED], size);
            f = clipped(wish, fmax(room - half, 0.0));
        } else if (row[LAW] == ENERGY) {
            f = clipped(wish, fmax(fabs(held + 2.0 * p * moved) - half, 0.0));
        } else if (row[LAW] == LEAP) {
            if (row[RESETS] > 0.0 && held == 0.0) energy = fmin(energy, 0.0);
            energy += held * moved + p * moved * moved + row[CREDITED] * fabs(moved);
            f = clipped(wish, sqrt(2.0 * row[SLOPE] * fmax(energy, 0.0)));
        } else {
            f = off > 0.0 ? 0.0 : fmax(base + row[SLOPE] * (q - reference), 0.0);
            if (left <= 0.0) {
                double room = sqrt(f * f + 2.0 * row[SLOPE] * spare), next = fmin(fmax(wish, 0.0), room);
                spare = fmax(spare + (f * f - next * next) / (2.0 * row[SLOPE]), 0.0);
                left = row[SAMPLES], reference = q, base = next, off = wish <= 0.0 ? 1.0 : 0.0;
                f = next;
            }
            left -= 1.0;
        }
        if (row[STEP] > 0.0) f = row[STEP] * floor(f / row[STEP] + 0.5);
        before = q, held = f;
        force[k] = f;
    }
}

/* The most that was taken out over what was lost until then, and when. */
static double taken(const double *law, const double *x, int n, const double *force, int late, int *at) {
    double out = 0.0, lost = 0.0, best = -1e300;
    *at = n - 1;
    for (int k = 0; k < n - 1; k++) {
        double moved = x[k + 1] - x[k], held = k >= late ? force[k - late] : 0.0;
        double took = law[FRICTION] * fabs(moved) + law[DRAG] * moved * moved;
        out -= held * moved + took;
        lost += took + 1e-12 * fabs(held * moved);
        if (k > 1 && lost > 0.0 && out / lost > best) { best = out / lost; *at = k + 1; }
    }
    return best;
}

/* The same search of a row of laws; `room`: 2 n numbers. */
double search_row(uint64_t seed, const double *law, const double *row, int late, int n, int motions, int climbs,
                  double *best, int *length, double *room) {
    Draws d = {seed};
    double *trial = room, *force = room + n, score = -1e300;
    int last = 0;
    for (int k = 0; k < motions + climbs; k++) {
        int end;
        if (k < motions) {
            draw(&d, law, k % FAMILIES, trial, n);
        } else {
            memcpy(trial, best, (size_t)n * sizeof *trial);
            change(&d, law, trial, n, 0);
        }
        inside(law, trial, n);
        forces(law, row, trial, n, force);
        double found = taken(law, trial, n, force, late, &end);
        if (found > score) {
            score = found, last = end;
            memcpy(best, trial, (size_t)n * sizeof *best);
        }
    }
    *length = last + 1;
    return score;
}
