/* The exact event-driven step in plain C: what the loop costs when nothing else is done.

   Under a constant force, sliding, m v' = F - f_c sgn v - b v; with a0 = v'(0) and rate = b/m

       v = v0 + a0 h1,   x = x0 + v0 t + a0 h2,   integral of v^2 = v0^2 t + 2 v0 a0 h2 + a0^2 h3

   with power series for h1, h2, h3, and v = 0 where h1 = -v0/a0. */
#include <math.h>

typedef struct {
    double mass, damping, coulomb, stiffness, resolution, period;
} Loop;

typedef struct {
    double h1, h2, h3;
} Response;

enum { HAND, ACTUATOR, VISCOUS, FRICTION, ENERGIES };

/* Twelve terms reach the last bit for rate * t <= 0.1; in this task it is 0.0042 at most. */
static Response respond(double rate, double t) {
    double power = 1.0, factorial = 2.0, two = 4.0; /* (-rate t)^n, (n + 2)!, 2^(n + 2) */
    double s1 = 0.0, s2 = 0.0, s3 = 0.0;
    for (int n = 0; n < 12; n++) {
        s1 += power * (n + 2) / factorial;
        s2 += power / factorial;
        s3 += power * (two - 2.0) / (factorial * (n + 3));
        power *= -rate * t;
        factorial *= n + 3;
        two *= 2.0;
    }
    return (Response){t * s1, t * t * s2, t * t * t * s3};
}

static inline double sampled_wall(const Loop *loop, double x) {
    const double measured = loop->resolution * floor(x / loop->resolution);
    return measured > 0.0 ? loop->stiffness * measured : 0.0;
}

/* Positions at the samples 0 ... n, the first one given; the energies at each sample. */
void simulate(const Loop *loop, const double *hand, long n, double *position, double (*energy)[ENERGIES]) {
    const double rate = loop->damping / loop->mass, per_mass = 1.0 / loop->mass;
    const Response whole = respond(rate, loop->period);
    double x = position[0], v = 0.0, sum[ENERGIES] = {0.0};
    for (long i = 0; i < n; i++) {
        const double wall = sampled_wall(loop, x), force = hand[i] - wall;
        double left = loop->period;
        Response h = whole;
        while (left > 0.0 && (v != 0.0 || fabs(force) > loop->coulomb)) {
            const double side = copysign(1.0, v != 0.0 ? v : force);
            const double free = (hand[i] - side * loop->coulomb - loop->damping * v) * per_mass;
            const double a0 = free - wall * per_mass;
            double t = left, after = (v + free * h.h1) - wall * (per_mass * h.h1);
            if (after * side <= 0.0) { /* it stops on the way */
                t = fmin(left, -log1p(rate * v / a0) / rate);
                h = respond(rate, t);
                after = 0.0;
            }
            /* the wall last: its force is what the next position waits for */
            const double ahead = v * t + free * h.h2, back = wall * (per_mass * h.h2);
            const double moved = ahead - back;
            sum[HAND] += hand[i] * moved;
            sum[ACTUATOR] -= wall * moved;
            sum[VISCOUS] += loop->damping * (v * v * t + 2.0 * v * a0 * h.h2 + a0 * a0 * h.h3);
            sum[FRICTION] += loop->coulomb * fabs(moved);
            x = (x + ahead) - back;
            v = after;
            left -= t;
            if (left > 0.0) h = respond(rate, left);
        }
        position[i + 1] = x;
        for (int e = 0; e < ENERGIES; e++) energy[i + 1][e] = sum[e];
    }
}

/* The chain x, floor, force, x that no single simulation can shorten: all else is added up beside it.
   No friction, no stop. */
void chain(const Loop *loop, const double *hand, long n, double *position) {
    const double gain = respond(loop->damping / loop->mass, loop->period).h2 / loop->mass;
    double x = position[0];
    for (long i = 0; i < n; i++) {
        x = (x + gain * hand[i]) - gain * sampled_wall(loop, x);
        position[i + 1] = x;
    }
}
