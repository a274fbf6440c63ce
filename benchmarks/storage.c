/* One sweep of value iteration by its definition; and what memory and arithmetic alone would take.  Of
   `available_storage.py`. */
#include <stdint.h>
#include <stdlib.h>

#define MOST(a, b) ((a) > (b) ? (a) : (b))
#define LEAST(a, b) ((a) < (b) ? (a) : (b))

/* shape: cells, histories, edges; `best` is scratch, twice 2 reach + 1. */
int64_t plain_sweep(int64_t *value, int64_t *choice, int64_t first, int64_t last, const int64_t *forces,
                    const int64_t *costs, int64_t most, const int64_t *nodes, int64_t reach, int64_t steps,
                    int64_t nowhere, const int64_t *shape, int64_t *best) {
    int64_t cells = shape[0], histories = shape[1], edges = shape[2], width = 2 * reach + 1;
    int64_t each = histories / width, improved = 0, *goal = best + width;
    for (int64_t group = first; group < last; group++) {
        int64_t n = group / each, newer = group % each;
        for (int64_t j = 0; j < edges; j++) {
            for (int64_t oldest = 0; oldest < width; oldest++) {
                int64_t here = n * histories + newer * width + oldest, f = forces[here];
                best[oldest] = value[here * edges + j], goal[oldest] = -1;
                if (f == nowhere) continue;
                for (int64_t n2 = MOST(0, n - reach); n2 <= LEAST(cells - 1, n + reach); n2++) {
                    int64_t there = (n2 * histories + (n - n2 + reach) * each + newer) * edges;
                    for (int64_t j2 = 0; j2 < edges; j2++) {
                        int64_t d = (n2 - n) * steps + nodes[j2] - nodes[j];
                        if (llabs(d) >= most) continue;
                        int64_t energy = value[there + j2] - costs[llabs(d)] - f * d;
                        if (energy > best[oldest]) best[oldest] = energy, goal[oldest] = there + j2;
                    }
                }
            }
            for (int64_t oldest = 0; oldest < width; oldest++) { /* all of them at once, as the hull does */
                if (goal[oldest] < 0) continue;
                int64_t at = (n * histories + newer * width + oldest) * edges + j;
                value[at] = best[oldest], choice[at] = goal[oldest];
                improved++;
            }
        }
    }
    return improved;
}

/* What the hull reads, as a plain stream: every target, every hull point, every state. */
int64_t loads_alone(const int64_t *values, const int64_t *forces, const int64_t *costs, const int64_t *nodes,
                    int64_t reach, int64_t points, const int64_t *shape, const int64_t *place, const int64_t *there) {
    int64_t cells = shape[0], histories = shape[1], edges = shape[2], seen = 0;
    for (int64_t n = 0; n < cells; n++) {
        for (int64_t n2 = MOST(0, n - reach); n2 <= LEAST(cells - 1, n + reach); n2++)
            for (int64_t j2 = 0; j2 < edges; j2++) seen += values[(n2 * histories + n - n2 + reach) * edges + j2];
        for (int64_t j = 0; j < edges; j++) {
            for (int64_t p = 0; p < points; p++)
                seen += values[n * histories * edges + there[p]] - costs[llabs(place[p] - nodes[j])];
            for (int64_t h = 0; h < histories; h++)
                seen += MOST(values[(n * histories + h) * edges + j], forces[n * histories + h]);
        }
    }
    return seen;
}

/* What the hull computes, in registers: the height of each, a comparison, the best of two corners. */
int64_t arithmetic_alone(int64_t targets, int64_t points, int64_t states, int64_t slope) {
    int64_t top = 0, at = 0, kept = 0;
    for (int64_t y = 0; y < targets; y++) {
        int64_t z = (y & 1023) - 3 * y * y;
        if (z - top > slope * (y - at)) top = z, at = y, kept++;
    }
    for (int64_t y = 0; y < points; y++) {
        int64_t z = (y & 1023) - (y >> 3);
        if (z - top > slope * (y - at)) top = z, at = y, kept++;
    }
    for (int64_t f = 0; f < states; f++)
        if (kept - f * (at + 1) > top - f * at) kept++;
    return kept;
}
