// The header of `rne emit panda --lang cuda -o panda.cuh`, compiled by `nvcc -O3 --fmad=false header.cu`: torques on the
// card beside those on the processor, bit by bit.
#include <cstdio>
#include <cstring>
#include <cstdlib>
#include "panda.cuh"

template <typename T> __global__ void torques(const T *q, const T *qd, const T *qdd, T *tau, int n)
{
    int i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i < n) panda_inverse_dynamics<T>(q + 7 * i, qd + 7 * i, qdd + 7 * i, tau + 7 * i);
}

template <typename T> int check(const char *name)
{
    const int n = 4099;
    T *a[4], *host[4];
    for (int k = 0; k < 4; k++) {
        cudaMallocManaged(&a[k], 7 * n * sizeof(T));
        host[k] = (T *)malloc(7 * n * sizeof(T));
        for (int i = 0; i < 7 * n; i++) a[k][i] = host[k][i] = (T)(4.0 * rand() / RAND_MAX - 2.0);
    }
    torques<T><<<(n + 63) / 64, 64>>>(a[0], a[1], a[2], a[3], n);
    cudaError_t error = cudaDeviceSynchronize();
    int differ = 0;
    for (int i = 0; i < n; i++) panda_inverse_dynamics<T>(host[0] + 7 * i, host[1] + 7 * i, host[2] + 7 * i, host[3] + 7 * i);
    for (int i = 0; i < 7 * n; i++) differ += memcmp(&a[3][i], &host[3][i], sizeof(T)) != 0;
    printf("header by nvcc, %s: %s, %d of %d numbers differ in a bit from the host\n", name, cudaGetErrorString(error), differ, 7 * n);
    return differ;
}

int main() { return check<float>("float") + check<double>("double"); }
