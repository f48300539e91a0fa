/*
 * The start of a program on a Cortex-M7: stack and entry, then the units of floating point, then the C library,
 * which prints and ends through the debugger (semihosting).
 */
void stack_top(void); /* an address of the linker's */
void _start(void);
void reset(void);

static void fault(void)
{
    for (;;) {
    }
}

__attribute__((section(".vectors"), used)) static void (*const vectors[16])(void) = {
    stack_top, reset, fault, fault, fault, fault, fault, fault,
    fault,     fault, fault, fault, fault, fault, fault, fault,
};

#define CPACR (*(volatile unsigned *)0xE000ED88u)

void reset(void)
{
    CPACR |= 0xFu << 20; /* full access to the coprocessors of floating point */
    __asm volatile("dsb\n\tisb");
    _start();
}
