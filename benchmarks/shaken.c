/* A thing, and two arms, that shake; and a device whose friction is not Coulomb's: small steps of Euler, friction
   taken at the end of each. */
#include <math.h>
#include <stdint.h>

static double sign(double a) { return (a > 0.0) - (a < 0.0); }
static double clipped(double f, double most) { return fmin(fmax(f, -most), most); }
static double slowed(double free, double drop) { return fabs(free) <= drop ? 0.0 : free - drop * sign(free); }

/* `shaken.py`: out is reading, command, motor's force and velocity, 4 x steps; `readings` steps + window,
   `past` behind, all 0 at first. */
void thing(const double *p, int64_t window, int64_t late, int64_t steps, int64_t fine, int64_t behind,
           double *readings, double *past, double *out) {
    const double mass = p[0], b = p[1], fc = p[2], res = p[3], T = p[4], K = p[5], B = p[6], both = p[7],
                 limit = p[8], mh = p[9], kh = p[10], ch = p[11], press = p[12], drag = p[13], kick = p[14],
                 Bd = p[15], fs = p[17], vs = p[18], shaft = p[19], cs = p[20], m2 = p[21], on_handle = p[22],
                 phase = p[23];
    const int stiff = shaft > 0.0;
    const double total = mass + (stiff ? 0.0 : mh), handle = m2 + mh, dt = T / fine;
    double x = 0.0, v = kick, x2 = 0.0, v2 = kick, drive_speed = 0.0, *command = out + steps;
    int64_t tick = 0;
    for (int64_t k = 0; k < steps; k++) {
        double r = floor((on_handle > 0 ? x2 : x) / res + phase) * res;
        if (k == 0)
            for (int64_t i = 0; i <= window && i < steps + window; i++) readings[i] = r;
        readings[k + window] = r;
        double u = K * r + B * (r - readings[k]) / (window * T);
        if (both == 0 && r <= 0.0) u = 0.0;
        if (limit > 0.0) u = clipped(u, limit);
        command[k] = u;
        double held = k >= late ? command[k - late] : 0.0, first = held + Bd * drive_speed;
        out[k] = r;
        out[2 * steps + k] = limit > 0.0 ? clipped(first, limit) : first;
        out[3 * steps + k] = on_handle > 0 ? v2 : v;
        for (int64_t i = 0; i < fine; i++) {
            double t = k * T + i * dt;
            if (Bd != 0.0) {
                drive_speed = past[tick % behind];
                past[tick % behind] = v;
                tick++;
            }
            double force = held + Bd * drive_speed;
            if (limit > 0.0) force = clipped(force, limit);
            double anchor = drag * t + (kh > 0 ? press / kh : 0.0), seat = stiff ? x2 : x, move = stiff ? v2 : v;
            double hand = kh > 0 ? kh * (anchor - seat) - ch * (move - drag) : press, push = -force;
            if (stiff) {
                double twist = shaft * (x - x2) + cs * (v - v2);
                push -= twist;
                v2 += dt * (hand + twist) / handle;
                x2 += dt * v2;
            } else {
                push += hand;
            }
            double rub = fc + (fs - fc) * exp(-((v / vs) * (v / vs)));
            v = slowed(v + dt * (push - b * v) / total, dt * rub / total);
            x += dt * v;
        }
        if (fabs(x) > 1e3) {
            for (int64_t row = 0; row < 4; row++)
                for (int64_t i = k; i < steps; i++) out[row * steps + i] = NAN;
            break;
        }
    }
}

/* `shaken_pairs.py`: out is 4 x 2 x steps. */
void arms(const double *p, int64_t late, int64_t link, int64_t steps, int64_t fine, double *out) {
    const double *mass = p, *viscous = p + 2, *coulomb = p + 4, res = p[6], T = p[7], K = p[8], B = p[9], D = p[10],
                 F = p[11], limit = p[12], kh = p[13], ch = p[14], slew = p[16], dt = T / fine;
    double x[2] = {0.0, 0.0}, v[2] = {p[15], 0.0}, wished[2], given[2] = {0.0, 0.0};
#define OUT(row, arm, k) out[((row) * 2 + (arm)) * steps + ((k) > 0 ? (k) : 0)]
    for (int64_t k = 0; k < steps; k++) {
        for (int a = 0; a < 2; a++) OUT(0, a, k) = floor(x[a] / res + 0.4) * res;
        for (int a = 0; a < 2; a++) {
            double own = OUT(0, a, k), before = OUT(0, a, k - 1);
            double there = OUT(0, 1 - a, k - link), earlier = OUT(0, 1 - a, k - link - 1);
            double speed = (own - before) / T, its = (there - earlier) / T;
            OUT(1, a, k) = K * (own - there) + B * (speed - its) + D * speed - F * sign(own - before);
            OUT(3, a, k) = v[a];
        }
        for (int a = 0; a < 2; a++) {
            wished[a] = clipped(OUT(1, a, k - late), limit);
            if (slew == 0.0) given[a] = wished[a];
            OUT(2, a, k) = given[a];
        }
        for (int64_t i = 0; i < fine; i++)
            for (int a = 0; a < 2; a++) {
                double hand = a == 0 ? -kh * x[a] - ch * v[a] : 0.0;
                if (slew > 0.0) given[a] += clipped(wished[a] - given[a], slew * dt);
                v[a] = slowed(v[a] + dt * (hand - given[a] - viscous[a] * v[a]) / mass[a], dt * coulomb[a] / mass[a]);
                x[a] += dt * v[a];
            }
    }
}

/* `identification_causes.py`: g(v) of a law of friction, */
enum { LINE, BENT, ARCTAN, LOGARITHM, ROOT };
double viscous(int64_t law, double b, double bend, double v) {
    if (law == BENT) return b * v / (1.0 + v / bend);
    if (law == ARCTAN) return b * bend * atan(v / bend);
    if (law == LOGARITHM) return b * bend * log(1.0 + v / bend);
    if (law == ROOT) return b * bend * (sqrt(1.0 + 2.0 * v / bend) - 1.0);
    return b * v;
}

/* and position, velocity and force of the hand at the samples, 3 x count.  p: step, stiffness and damping of the
   hand, mass, coulomb, inward, outward, bend, bump, its speed, cogging, its pitch. */
void moved(const double *wanted, int64_t count, int64_t every, const double *p, int64_t one, int64_t other,
           double *out) {
    const double step = p[0], mass = p[3], bend = p[7], bump = p[8], bump_speed = p[9], cogging = p[10], pitch = p[11];
    double x = wanted[0], v = 0.0;
    for (int64_t i = 0; i < count * every; i++) {
        double hand = p[1] * (wanted[i] - x) - p[2] * v;
        if (i % every == 0) {
            out[i / every] = x;
            out[count + i / every] = v;
            out[2 * count + i / every] = hand;
        }
        double free = v + step / mass * (hand - cogging * sin(2.0 * 3.14159265358979323846 * x / pitch));
        double speed = fabs(free), friction = p[4] + (free > 0.0 ? viscous(one, p[5], bend, speed) : viscous(other, p[6], bend, speed));
        if (bump > 0.0) friction += bump * exp(-((speed / bump_speed) * (speed / bump_speed)));
        v = (free > 0.0 ? 1.0 : -1.0) * fmax(speed - step / mass * friction, 0.0);
        x += step * v;
    }
}
