// Runs generated C on the MPS2 boards that QEMU emulates, and prints what the certificate reads: the lines of ../board.

#include "board.h"

#include <stddef.h>

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))
#define STATES 32u

// G. Marsaglia's generator, as in ../../robots/src/states.rs.
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
static uint32_t semihosting(uint32_t operation, const void *argument)
{
    register uint32_t r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}

// Set before it is used: nothing else clears it.
static uint32_t standard_output;

static void open_standard_output(void)
{
    static const char name[] = ":tt";
    const uint32_t arguments[3] = {(uint32_t)name, 4u, sizeof name - 1u}; // 4: for writing
    standard_output = semihosting(1u, arguments);
}

static void put(const char *text)
{
    uint32_t length = 0;
    while (text[length] != '\0') {
        length++;
    }
    const uint32_t arguments[3] = {standard_output, (uint32_t)text, length};
    (void)semihosting(5u, arguments);
}

__attribute__((noreturn)) static void end(uint32_t code)
{
    const uint32_t arguments[2] = {0x20026u, code}; // ADP_Stopped_ApplicationExit
    (void)semihosting(0x20u, arguments);
    for (;;) {
    }
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

#define SYST ((volatile uint32_t *)0xE000E010u) // control, reload, current

uint32_t timer(void)
{
    return SYST[2];
}

void print_ticks(const char *what, uint32_t start, uint32_t end)
{
    put("ticks ");
    put(what);
    put(" ");
    put_number((start - end) & 0xFFFFFFu);
    put("\n");
}

int main(void)
{
    SYST[1] = 0xFFFFFFu;
    SYST[2] = 0u;
    SYST[0] = 5u; // the clock of the processor, no interrupt
    open_standard_output();
    for (uint32_t number = 0; number < STATES; number++) {
        run_cases(number);
    }
    end(0u);
}

extern uint32_t stack_start[];

__attribute__((naked)) void reset(void)
{
    // the floating-point unit on, before any function saves its registers
    __asm__ volatile("ldr r0, =0xE000ED88\n ldr r1, [r0]\n orr r1, r1, #0xF00000\n str r1, [r0]\n dsb\n isb\n b main");
}

static void fault(void)
{
    end(1u);
}

// What the processor reads first: where the stack starts, then what it does at reset and at each fault.
__attribute__((section(".vectors"), used)) static const struct {
    uint32_t *stack;
    void (*handlers[6])(void);
} vectors = {stack_start, {reset, fault, fault, fault, fault, fault}};
