/* The Hapkit's chip, cycle by cycle, by simavr: the handle swings, and what goes over the line is kept.
 *
 *     chip FIRMWARE MILLISECONDS LINE [HANG]
 *
 * At HANG milliseconds the timer of the samples is switched off: the chip hangs.  What is printed: samples; the
 * least and the most cycles from one to the next; the most cycles that one took; the pulse widths at the end, at
 * most, and as it hung.
 */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <simavr/avr_adc.h>
#include <simavr/avr_uart.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_elf.h>
#include <simavr/sim_interrupts.h>
#include <simavr/sim_io.h>

enum { TIMER1_COMPA = 11, CLOCKS = 16000, TCCR0A = 0x44, OCR0B = 0x48, TIMSK1 = 0x6F, COM0B1 = 0x20 };

static FILE *line;
static uint64_t begun, samples, most, least_apart = UINT64_MAX, most_apart;
static avr_irq_t *sensor;

static void heard(avr_irq_t *irq, uint32_t value, void *of) {
  (void)irq;
  (void)of;
  fputc((int)(value & 0xFF), line);
}

/* The handle at 6 mm/s and more, over a jump of the sensor's sawtooth: 0 counts at the start, into the wall. */
static void ask_sensor(avr_irq_t *irq, uint32_t value, void *of) {
  const avr_t *avr = of;
  const double t = (double)avr->cycle / avr->frequency;
  int counts = (int)floor(500.0 - 400.0 * sin(12.0 * t));
  (void)irq;
  (void)value;
  counts = counts > 980 ? counts - 980 : counts;
  avr_raise_irq(sensor, (uint32_t)((counts + 0.5) * 5000.0 / 1024.0));
}

static void running(avr_irq_t *irq, uint32_t value, void *of) {
  const avr_t *avr = of;
  (void)irq;
  if (value) {
    const uint64_t apart = avr->cycle - begun;
    if (samples++ > 1) {
      least_apart = apart < least_apart ? apart : least_apart;
      most_apart = apart > most_apart ? apart : most_apart;
    }
    begun = avr->cycle;
  } else if (avr->cycle - begun > most) {
    most = avr->cycle - begun;
  }
}

static int width(const avr_t *avr) { return avr->data[TCCR0A] & COM0B1 ? avr->data[OCR0B] : 0; }

int main(int count, char **words) {
  static elf_firmware_t firmware;
  uint64_t end, hang = UINT64_MAX;
  int widest = 0, acted = 0;
  if (count < 4 || elf_read_firmware(words[1], &firmware) != 0) {
    return 2;
  }
  avr_t *avr = avr_make_mcu_by_name("atmega328p");
  avr_init(avr);
  avr_load_firmware(avr, &firmware);
  avr->frequency = 16000000;
  avr->vcc = avr->avcc = avr->aref = 5000;
  avr->log = LOG_NONE;
  end = strtoull(words[2], NULL, 10) * CLOCKS;
  line = fopen(words[3], "wb");
  if (count > 4) {
    hang = strtoull(words[4], NULL, 10) * CLOCKS;
  }
  uint32_t flags = 0;
  avr_ioctl(avr, AVR_IOCTL_UART_GET_FLAGS('0'), &flags);
  flags &= ~AVR_UART_FLAG_STDIO;
  avr_ioctl(avr, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
  avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUTPUT), heard, NULL);
  sensor = avr_io_getirq(avr, AVR_IOCTL_ADC_GETIRQ, ADC_IRQ_ADC2);
  avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_ADC_GETIRQ, ADC_IRQ_OUT_TRIGGER), ask_sensor, avr);
  avr_irq_register_notify(avr_get_interrupt_irq(avr, TIMER1_COMPA) + AVR_INT_IRQ_RUNNING, running, avr);
  while (avr->cycle < end) {
    const int state = avr_run(avr);
    if (state == cpu_Done || state == cpu_Crashed) {
      return 3;
    }
    if (avr->cycle >= hang) {
      avr->data[TIMSK1] = 0;
      acted = width(avr);
      hang = UINT64_MAX;
    }
    widest = width(avr) > widest ? width(avr) : widest;
  }
  printf("%llu %llu %llu %llu %d %d %d\n", (unsigned long long)samples, (unsigned long long)least_apart,
         (unsigned long long)most_apart, (unsigned long long)most, width(avr), widest, acted);
  fclose(line);
  return 0;
}
