/* The Hapkit's chip, cycle by cycle, by simavr: its sensor is told where the handle is, its line is kept. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <simavr/avr_adc.h>
#include <simavr/avr_uart.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_elf.h>
#include <simavr/sim_interrupts.h>
#include <simavr/sim_io.h>

enum { TIMER1_COMPA = 11, TCCR0A = 0x44, OCR0B = 0x48, TIMSK1 = 0x6F, COM0B1 = 0x20 };

typedef struct {
  avr_t *avr;
  elf_firmware_t firmware;
  FILE *line;
  avr_irq_t *sensor;
  int reading, ended;
  uint64_t deaf;  /* until when, where interrupts are off [cycles] */
  uint64_t at[2]; /* where the last sample began, and ended [cycles] */
} board;

static void quiet(avr_t *avr, const int level, const char *format, va_list values) {
  (void)avr, (void)level, (void)format, (void)values;
}

static void heard(avr_irq_t *irq, uint32_t value, void *of) {
  board *b = of;
  (void)irq;
  fputc((int)(value & 0xFF), b->line);
}

static void asked(avr_irq_t *irq, uint32_t value, void *of) {
  board *b = of;
  (void)irq, (void)value;
  avr_raise_irq(b->sensor, (uint32_t)((b->reading + 0.5) * 5000.0 / 1024.0));
}

static void sampling(avr_irq_t *irq, uint32_t begins, void *of) {
  board *b = of;
  (void)irq;
  b->at[begins ? 0 : 1] = b->avr->cycle;
  b->ended |= !begins;
}

void board_close(board *b) {
  avr_terminate(b->avr);
  fclose(b->line);
  free(b);
}

board *board_open(const char *program, const char *line) {
  board *b = calloc(1, sizeof *b);
  uint32_t flags = 0;
  avr_global_logger_set(quiet);
  avr_t *avr = b->avr = avr_make_mcu_by_name("atmega328p");
  b->line = fopen(line, "wb");
  if (!avr || !b->line || elf_read_firmware(program, &b->firmware))
    return NULL;
  avr_init(avr);
  avr_load_firmware(avr, &b->firmware);
  avr->frequency = 16000000;
  avr->vcc = avr->avcc = avr->aref = 5000;
  avr_ioctl(avr, AVR_IOCTL_UART_GET_FLAGS('0'), &flags);
  flags &= ~AVR_UART_FLAG_STDIO;
  avr_ioctl(avr, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
  avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUTPUT), heard, b);
  b->sensor = avr_io_getirq(avr, AVR_IOCTL_ADC_GETIRQ, ADC_IRQ_ADC2);
  avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_ADC_GETIRQ, ADC_IRQ_OUT_TRIGGER), asked, b);
  avr_irq_register_notify(avr_get_interrupt_irq(avr, TIMER1_COMPA) + AVR_INT_IRQ_RUNNING, sampling, b);
  return b;
}

/* With this reading of the sensor to the end of a sample, or to this cycle: 1, 0; -1 where the program ends. */
int board_run(board *b, int reading, uint64_t until, uint64_t at[2]) {
  b->reading = reading;
  b->ended = 0;
  while (!b->ended && b->avr->cycle < until) {
    if (b->deaf && b->avr->cycle >= b->deaf) {
      b->deaf = 0;
      b->avr->sreg[S_I] = 1;
      b->avr->interrupt_state = -1; /* an instruction on, as after sei */
    }
    const int state = avr_run(b->avr);
    if (state == cpu_Done || state == cpu_Crashed)
      return -1;
  }
  at[0] = b->at[0];
  at[1] = b->ended ? b->at[1] : b->avr->cycle;
  return b->ended;
}

/* No interrupt is answered before this cycle, as in code that has switched them off. */
void board_deaf(board *b, uint64_t until) {
  b->deaf = until;
  b->avr->sreg[S_I] = 0;
  b->avr->interrupt_state = 0;
}

/* The timer of the samples is switched off: the chip hangs. */
void board_hang(board *b) { b->avr->data[TIMSK1] = 0; }

int board_width(const board *b) { return b->avr->data[TCCR0A] & COM0B1 ? b->avr->data[OCR0B] : 0; }
