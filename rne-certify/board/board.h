#ifndef BOARD_H
#define BOARD_H

#include <stdint.h>

// Positions, velocities and accelerations of up to seven joints.
struct state {
    float q[7], qd[7], qdd[7];
};

// The state of a number, as in ../robots/src/states.rs.
struct state state_of(uint32_t number, uint32_t dof);

// A line of results.
void print_results(const char *what, uint32_t state, const float *numbers, uint32_t count);

// Calls every function at a state and prints what it returns; generated.
void run_cases(uint32_t state);

#endif
