/* An ATmega328P by libsimavr, for a program as avr_main.c: gives counts, takes forces, counts cycles. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <simavr/sim_avr.h>
#include <simavr/sim_elf.h>

enum { GPIOR0 = 0x3E, GPIOR1 = 0x4A, GPIOR2 = 0x4B };
enum { READY = 1, BEGIN = 2, END = 3 };
enum { FORCE_AT = 4, WANTED_AT = 8, BYTES_AT = 9, WHOLE_AT = 10, ROOM = 11 };
enum { LONGEST = 4000000 }; /* cycles: a quarter of a second */

typedef struct {
    avr_t *avr;
    elf_firmware_t firmware;
    avr_cycle_count_t begun, taken;
    int ready;
} machine;

static void quiet(avr_t *avr, const int level, const char *format, va_list values) {
    (void)avr, (void)level, (void)format, (void)values;
}

static void signalled(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param) {
    machine *m = param;
    avr->data[address] = value;
    if (value == BEGIN)
        m->begun = avr->cycle;
    else if (value == END)
        m->taken = avr->cycle - m->begun;
    else {
        m->ready = 1;
        avr->state = cpu_Stopped;
    }
}

/* Runs until the program is ready for the next: 0; -1 if it ended, -2 if it takes too long. */
static int until_ready(machine *m) {
    avr_cycle_count_t last = m->avr->cycle + LONGEST;
    m->ready = 0;
    m->avr->state = cpu_Running;
    while (!m->ready) {
        int state = avr_run(m->avr);
        if (!m->ready && (state == cpu_Done || state == cpu_Crashed))
            return -1;
        if (m->avr->cycle > last)
            return -2;
    }
    return 0;
}

static uint8_t *exchanged(machine *m) {
    return m->avr->data + (m->avr->data[GPIOR1] | m->avr->data[GPIOR2] << 8);
}

void machine_close(machine *m) {
    avr_terminate(m->avr);
    free(m);
}

machine *machine_open(const char *program, const char *chip, uint32_t frequency) {
    avr_global_logger_set(quiet);
    machine *m = calloc(1, sizeof *m);
    m->avr = avr_make_mcu_by_name(chip);
    if (!m->avr || elf_read_firmware(program, &m->firmware))
        return NULL;
    avr_init(m->avr);
    avr_load_firmware(m->avr, &m->firmware);
    m->avr->frequency = frequency;
    avr_register_io_write(m->avr, GPIOR0, signalled, m);
    if (until_ready(m) || exchanged(m) + ROOM > m->avr->data + m->avr->ramend) {
        machine_close(m);
        return NULL;
    }
    return m;
}

int machine_bytes(machine *m) { return exchanged(m)[BYTES_AT]; }

int machine_whole(machine *m) { return exchanged(m)[WHOLE_AT]; }

/* What is wanted with these counts, one after the other; forces as the program has them. */
int machine_run(machine *m, int wanted, const int32_t *counts, uint8_t *forces, uint32_t *cycles, long n) {
    int bytes = machine_bytes(m);
    for (long k = 0; k < n; k++) {
        memcpy(exchanged(m), counts + k, 4);
        exchanged(m)[WANTED_AT] = (uint8_t)wanted;
        int failed = until_ready(m);
        if (failed)
            return failed;
        memcpy(forces + k * bytes, exchanged(m) + FORCE_AT, bytes);
        cycles[k] = (uint32_t)m->taken;
    }
    return 0;
}
