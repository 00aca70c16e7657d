/* The widest vector of doubles of the machine the file is compiled for, and libmvec's sine and cosine of it. */
#ifndef VECTOR_H
#define VECTOR_H
#include <stddef.h>
#ifdef __AVX512F__
#define LANES 8
typedef double vec __attribute__((vector_size(64)));
vec _ZGVeN8v_sin(vec);
vec _ZGVeN8v_cos(vec);
#define vec_sin _ZGVeN8v_sin
#define vec_cos _ZGVeN8v_cos
#else
#define LANES 4
typedef double vec __attribute__((vector_size(32)));
vec _ZGVdN4v_sin(vec);
vec _ZGVdN4v_cos(vec);
#define vec_sin _ZGVdN4v_sin
#define vec_cos _ZGVdN4v_cos
#endif
#endif
