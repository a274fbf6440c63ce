/* What every translated function may need: arrays, and the arithmetic of Python where C has another. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <math.h>

#if defined(FLT_EVAL_METHOD) && FLT_EVAL_METHOD != 0 && FLT_EVAL_METHOD != 16
#error "doubles must be calculated as doubles"
#endif

typedef struct { double *p; int64_t n[4]; } zw_reals;
typedef struct { int64_t *p; int64_t n[4]; } zw_wholes;
typedef struct { uint8_t *p; int64_t n[4]; } zw_bytes;

static inline void zw_let_go(void *owned) { free(*(void **)owned); }
#define zw_own __attribute__((cleanup(zw_let_go), unused)) void *

static inline int64_t zw_size(const int64_t *n) { return n[0] * n[1] * n[2] * n[3]; }
#ifdef ZW_CHECKED /* for those who look for a step that leaves its array */
#include <stdio.h>
static inline int64_t zw_inside(int64_t at, const int64_t *n, const char *where, int line) {
    if (at >= 0 && at < zw_size(n)) return at;
    fprintf(stderr, "%s, line %d: %lld of %lld\n", where, line, (long long)at, (long long)zw_size(n));
    abort();
}
#define ZW_AT(at, n) zw_inside(at, n, __func__, __LINE__)
#else
#define ZW_AT(at, n) (at)
#endif

static inline double zw_min_real(double a, double b) { return b < a ? b : a; }
static inline double zw_max_real(double a, double b) { return b > a ? b : a; }
static inline int64_t zw_min_whole(int64_t a, int64_t b) { return b < a ? b : a; }
static inline int64_t zw_max_whole(int64_t a, int64_t b) { return b > a ? b : a; }
/* gcc makes -b of 0.0 - b where it knows that b is not -0.0, and so -0.0 of 0.0 - 0.0 */
static inline double zw_opposite(double b) { return b == 0 ? 0.0 : -b; }
static inline int64_t zw_abs(int64_t a) { return a < 0 ? -a : a; }

/* without the instruction of newer processors a call of floor takes longer than the rest of a sample */
static inline double zw_floor(double x) {
#ifdef __SSE4_1__
    return floor(x);
#else
    if (!(fabs(x) < 4503599627370496.0)) return x;
    double t = (double)(int64_t)x;
    t -= (double)(t > x);
    return copysign(t, x);
#endif
}

/* divided by 0 a whole number is 0: Python raises, the processor would end the process */
static inline int64_t zw_over_whole(int64_t a, int64_t b) {
    if (b == 0) return 0;
    if (b == -1) return -a;
    int64_t q = a / b;
    return q * b != a && (a < 0) != (b < 0) ? q - 1 : q;
}
static inline int64_t zw_rest_whole(int64_t a, int64_t b) {
    if (b == 0 || b == -1) return 0;
    int64_t r = a % b;
    return r != 0 && (r < 0) != (b < 0) ? r + b : r;
}
static inline double zw_rest_real(double a, double b) {
    double r = fmod(a, b);
    if (r == 0) return copysign(0.0, b);
    return (r < 0) != (b < 0) ? r + b : r;
}
static inline double zw_over_real(double a, double b) {
    double r = fmod(a, b), q = (a - r) / b;
    if (r != 0 && (r < 0) != (b < 0)) q -= 1.0;
    if (q == 0) return copysign(0.0, a / b);
    double f = floor(q);
    return q - f > 0.5 ? f + 1.0 : f;
}
static inline int64_t zw_power_whole(int64_t a, int64_t n) {
    int64_t r = 1;
    while (n-- > 0) r *= a;
    return r;
}
static inline double zw_power_real(double a, int64_t n) { return n == 2 ? a * a : NAN; }

#define ZW_ARRAY(kind, item)                                                                            \
    static inline zw_##kind##s zw_part_##kind(zw_##kind##s a, int k, int64_t at, int64_t i, int64_t j) { \
        zw_##kind##s r = {0, {j > i ? j - i : 0, 1, 1, 1}};                                             \
        int64_t each = 1;                                                                               \
        for (int m = k + 1; m < 4; m++) { each *= a.n[m]; r.n[m - k] = a.n[m]; }                        \
        r.p = a.p + (at * a.n[k] + i) * each;                                                           \
        return r;                                                                                       \
    }                                                                                                   \
    static inline zw_##kind##s zw_shaped_##kind(zw_##kind##s a, int count, const int64_t *n) {          \
        zw_##kind##s r = {a.p, {1, 1, 1, 1}};                                                           \
        int64_t known = 1, open = -1;                                                                   \
        for (int m = 0; m < count; m++) {                                                               \
            r.n[m] = n[m];                                                                              \
            if (n[m] < 0) open = m; else known *= n[m];                                                 \
        }                                                                                               \
        if (open >= 0) r.n[open] = zw_size(a.n) / known;                                                \
        return r;                                                                                       \
    }                                                                                                   \
    static inline zw_##kind##s zw_new_##kind(void **own, int count, const int64_t *n) {                 \
        zw_##kind##s r = {0, {1, 1, 1, 1}};                                                             \
        for (int m = 0; m < count; m++) r.n[m] = n[m];                                                  \
        free(*own);                                                                                     \
        *own = r.p = calloc((size_t)zw_size(r.n) + 1, sizeof(item));                                    \
        if (!r.p) abort();                                                                              \
        return r;                                                                                       \
    }                                                                                                   \
    static inline zw_##kind##s zw_copied_##kind(void **own, zw_##kind##s a) {                           \
        zw_##kind##s r = zw_new_##kind(own, 4, a.n);                                                    \
        memcpy(r.p, a.p, (size_t)zw_size(a.n) * sizeof(item));                                          \
        return r;                                                                                       \
    }                                                                                                   \
    static inline void zw_fill_##kind(zw_##kind##s a, item value) {                                     \
        for (int64_t i = 0, size = zw_size(a.n); i < size; i++) a.p[i] = value;                         \
    }                                                                                                   \
    static inline void zw_copy_##kind(zw_##kind##s a, zw_##kind##s b) {                                 \
        memmove(a.p, b.p, (size_t)zw_size(a.n) * sizeof(item));                                         \
    }                                                                                                   \
    static inline zw_##kind##s zw_filled_##kind(zw_##kind##s a, item value) {                           \
        zw_fill_##kind(a, value);                                                                       \
        return a;                                                                                       \
    }                                                                                                   \
    static inline item zw_largest_##kind(zw_##kind##s a) {                                              \
        item most = a.p[0];                                                                             \
        for (int64_t i = 1, size = zw_size(a.n); i < size; i++) most = a.p[i] > most ? a.p[i] : most;   \
        return most;                                                                                    \
    }
ZW_ARRAY(real, double)
ZW_ARRAY(whole, int64_t)
ZW_ARRAY(byte, uint8_t)
static inline zw_wholes zw_counted_whole(zw_wholes a) {
    for (int64_t i = 0; i < a.n[0]; i++) a.p[i] = i;
    return a;
}
