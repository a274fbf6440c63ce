/* From reset to main: data copied, the rest cleared, the floating-point unit on where there is one. */
#include <stdint.h>

extern uint32_t data_stored[], data_begin[], data_end[], bss_begin[], bss_end[], stack_top[];

int main(void);
void SysTick_Handler(void);
void fault(void);
void Reset_Handler(void);

void Reset_Handler(void) {
  uint32_t *from = data_stored;
  for (uint32_t *to = data_begin; to < data_end;) {
    *to++ = *from++;
  }
  for (uint32_t *to = bss_begin; to < bss_end;) {
    *to++ = 0;
  }
#ifdef __ARM_FP
  *(volatile uint32_t *)0xE000ED88u |= 0xFu << 20; /* CPACR: coprocessors 10 and 11 */
  __asm volatile("dsb\n isb");
#endif
  main();
  fault();
}

typedef union {
  void *stack;
  void (*handler)(void);
} vector;

__attribute__((section(".vectors"), used)) static const vector vectors[16] = {
    {.stack = stack_top},
    {.handler = Reset_Handler},
    {.handler = fault}, /* not maskable */
    {.handler = fault}, /* hard fault */
    {.handler = fault}, /* memory management */
    {.handler = fault}, /* bus */
    {.handler = fault}, /* usage */
    {.handler = fault},
    {.handler = fault},
    {.handler = fault},
    {.handler = fault},
    {.handler = fault}, /* supervisor call */
    {.handler = fault},
    {.handler = fault},
    {.handler = fault}, /* PendSV */
    {.handler = SysTick_Handler},
};
