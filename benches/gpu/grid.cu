// Times functions of GRiD (github.com/robot-acceleration/GRiD) beside the kernels of rne; benches/gpu/all.sh builds it with
// the grid.cuh that GRiD's generateGRiD.py writes from panda.urdf. Arrays stay on the card; GRiD computes a state per
// block. The calls are those of timeGRiD.cu of GRiDBenchmarks. Prints ns per state, float.
#include "grid.cuh"
#include <cstdio>
#include <vector>

#ifndef STATES
#define STATES 65536
#endif

template <typename Launch>
static void time_of(const char *name, Launch launch)
{
    cudaEvent_t begin, end;
    gpuErrchk(cudaEventCreate(&begin));
    gpuErrchk(cudaEventCreate(&end));
    launch();
    gpuErrchk(cudaDeviceSynchronize());
    const int launches = 20;
    gpuErrchk(cudaEventRecord(begin));
    for (int k = 0; k < launches; ++k) {
        launch();
    }
    gpuErrchk(cudaEventRecord(end));
    gpuErrchk(cudaEventSynchronize(end));
    float milliseconds = 0;
    gpuErrchk(cudaEventElapsedTime(&milliseconds, begin, end));
    std::printf("GRiD %-28s float %8.3f ns per state, %d states\n", name, 1e6 * milliseconds / launches / STATES, STATES);
}

int main()
{
    typedef float T;
    const T gravity = static_cast<T>(9.81);
    const dim3 threads(grid::SUGGESTED_THREADS, 1, 1), blocks(STATES, 1, 1);
    cudaStream_t *streams = grid::init_grid<T>();
    grid::robotModel<T> *robot = grid::init_robotModel<T>();
    grid::gridData<T> *data = grid::init_gridData<T, STATES>();
    const int numbers = 3 * grid::NUM_JOINTS * STATES;
    for (int k = 0; k < numbers; ++k) {
        data->h_q_qd_u[k] = static_cast<T>((k * 7919 % 2001) / 1000.0 - 1.0);
    }
    gpuErrchk(cudaMemcpy(data->d_q_qd_u, data->h_q_qd_u, numbers * sizeof(T), cudaMemcpyHostToDevice));
    time_of("inverse_dynamics (qdd = 0)", [&] {
        grid::inverse_dynamics_compute_only<T, false, false>(data, robot, gravity, STATES, blocks, threads);
    });
    time_of("forward_dynamics", [&] {
        grid::forward_dynamics_compute_only<T>(data, robot, gravity, STATES, blocks, threads);
    });
    time_of("inverse_dynamics_derivatives", [&] {
        grid::inverse_dynamics_gradient_compute_only<T, false, false>(data, robot, gravity, STATES, blocks, threads);
    });
    grid::close_grid<T>(streams, robot, data);
    return 0;
}
