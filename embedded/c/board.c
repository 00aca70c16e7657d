// Runs generated C on the MPS2 boards that QEMU emulates, and prints what the certificate reads: the lines of ../board.

#include "board.h"

#include <stddef.h>

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))
#define STATES 8u

// G. Marsaglia's generator, as in ../robots/src/states.rs.
static uint32_t xorshift(uint32_t *x)
{
    *x ^= *x << 13u;
    *x ^= *x >> 17u;
    *x ^= *x << 5u;
    return *x;
}

struct state state_of(uint32_t number, uint32_t dof)
{
    struct state state;
    uint32_t x = (number * 747796405u + 2891336453u) | 1u;
    float *const rows[3] = {state.q, state.qd, state.qdd};
    for (size_t row = 0; row < COUNT(rows); row++) {
        for (uint32_t joint = 0; joint < dof; joint++) {
            rows[row][joint] = (float)(xorshift(&x) >> 8u) * (6.0f / 16777216.0f) - 3.0f;
        }
    }
    return state;
}

// Semihosting: QEMU does what the registers say.
static void semihosting(uint32_t operation, const void *argument)
{
    register uint32_t r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
}

static void put(const char *text)
{
    semihosting(4u, text);
}

static void put_number(uint32_t number)
{
    char digits[11];
    char *first = &digits[10];
    *first = '\0';
    do {
        *--first = (char)('0' + number % 10u);
        number /= 10u;
    } while (number != 0u);
    put(first);
}

void print_results(const char *what, uint32_t state, const float *numbers, uint32_t count)
{
    put(what);
    put(" ");
    put_number(state);
    for (uint32_t i = 0; i < count; i++) {
        union {
            float number;
            uint32_t bits;
        } word;
        char text[10] = " ";
        word.number = numbers[i];
        for (size_t digit = 0; digit < 8; digit++) {
            text[digit + 1] = "0123456789abcdef"[word.bits >> (28u - 4u * digit) & 15u];
        }
        text[9] = '\0';
        put(text);
    }
    put("\n");
}

int main(void)
{
    for (uint32_t number = 0; number < STATES; number++) {
        run_cases(number);
    }
    const uint32_t exit_with[2] = {0x20026u, 0u}; // ADP_Stopped_ApplicationExit
    semihosting(0x20u, exit_with);
    for (;;) {
    }
}

extern uint32_t stack_start[];

__attribute__((naked)) void reset(void)
{
    // the floating-point unit on, before any function saves its registers
    __asm__ volatile("ldr r0, =0xE000ED88\n ldr r1, [r0]\n orr r1, r1, #0xF00000\n str r1, [r0]\n dsb\n isb\n b main");
}

static void fault(void)
{
    put("a fault\n");
    const uint32_t exit_with[2] = {0x20026u, 1u};
    semihosting(0x20u, exit_with);
    for (;;) {
    }
}

typedef void (*handler)(void);

__attribute__((section(".vectors"), used)) static const handler vectors[] = {
    (handler)stack_start, reset, fault, fault, fault, fault, fault,
};
