#ifndef BOARD_H
#define BOARD_H

#include <stdint.h>

// Positions, velocities and accelerations of up to 32 joints.
struct state {
    float q[32], qd[32], qdd[32];
};

// The state of a number, as in ../../robots/src/states.rs.
struct state state_of(uint32_t number, uint32_t dof);

// A line of results.
void print_results(const char *what, uint32_t state, const float *numbers, uint32_t count);

// The timer SysTick: it counts down once per clock of the processor, with 24 bits.
uint32_t timer(void);

// A line with the ticks between two readings of the timer.
void print_ticks(const char *what, uint32_t start, uint32_t end);

// Calls every function at a state and prints what it returns; generated.
void run_cases(uint32_t state);

#endif
