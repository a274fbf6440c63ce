/* What the operating system is asked for, and the bits of numbers: written by hand. */
#define ZW_SEEN __attribute__((visibility("default")))
typedef union { double f; int64_t i; void *p; } zw_word;

#ifndef _WIN32
#include <time.h>
#include <unistd.h>

static int64_t machine_servo_posix_now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (int64_t)t.tv_sec * 1000000000 + t.tv_nsec;
}
static void machine_servo_posix_pause(int64_t nanoseconds) {
    if (nanoseconds > 0) {
        struct timespec t = {nanoseconds / 1000000000, nanoseconds % 1000000000};
        nanosleep(&t, 0);
    }
}
static int64_t machine_servo_posix_read_some(int64_t descriptor, const zw_bytes *into, int64_t start) {
    int64_t room = into->n[0] - start;
    if (room <= 0) return 0;
    int64_t count = read((int)descriptor, into->p + start, (size_t)room);
    return count > 0 ? count : count == 0 ? -2 : -1;
}
static int64_t machine_servo_posix_write_all(int64_t descriptor, const zw_bytes *what, int64_t count) {
    return write((int)descriptor, what->p, (size_t)count) == count;
}
#else /* nothing is served there: see check_supported */
static int64_t machine_servo_posix_now(void) { return 0; }
static void machine_servo_posix_pause(int64_t nanoseconds) { (void)nanoseconds; }
static int64_t machine_servo_posix_read_some(int64_t descriptor, const zw_bytes *into, int64_t start) {
    (void)descriptor; (void)into; (void)start;
    return -2;
}
static int64_t machine_servo_posix_write_all(int64_t descriptor, const zw_bytes *what, int64_t count) {
    (void)descriptor; (void)what; (void)count;
    return 0;
}
#endif

static double machine_servo_devices_frames__float_of(int64_t bits) {
    uint32_t low = (uint32_t)bits;
    float f;
    memcpy(&f, &low, 4);
    return (double)f;
}
static int64_t machine_servo_devices_frames__bits_of(double value) {
    float f = (float)value;
    uint32_t bits;
    memcpy(&bits, &f, 4);
    return (int64_t)bits;
}
