// optimisers ROBOTS ROBOT STATES REPETITIONS: what optimisers call, beside Pinocchio. Every competitor is checked against
// the first of its function, then all are timed in turn. Output: function, competitor, median ns per call.
#include <pinocchio/algorithm/aba-derivatives.hpp>
#include <pinocchio/algorithm/rnea-derivatives.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <map>

#include "optimisers.h"
#include "pinocchio_model.hpp"

namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Clock = std::chrono::steady_clock;

pinocchio::Model* model;
pinocchio::Data* data;

auto part(const double* x, int k) { return Eigen::Map<const Eigen::VectorXd>(x + k * model->nv, model->nv); }

void torque_derivatives(const double* x, double*) {
  pinocchio::computeRNEADerivatives(*model, *data, part(x, 0), part(x, 1), part(x, 2));
}
void acceleration_derivatives(const double* x, double*) {
  pinocchio::computeABADerivatives(*model, *data, part(x, 0), part(x, 1), part(x, 2));
}

// Pinocchio keeps its results; they are copied for the check alone.
void copy_results(const std::string& function, double* out) {
  auto put = [&](const Matrix& matrix) { out = std::copy(matrix.data(), matrix.data() + matrix.size(), out); };
  if (function == "torque derivatives") put(data->dtau_dq), put(data->dtau_dv);
  if (function == "acceleration derivatives")
    put(data->ddq_dq), put(data->ddq_dv), put(data->Minv.selfadjointView<Eigen::Upper>());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  const pinocchio::Model of_robot = pinocchio_model(read_flat(argv[1], argv[2]));
  pinocchio::Data of_states(of_robot);
  model = const_cast<pinocchio::Model*>(&of_robot), data = &of_states;
  const size_t row = 4 * of_robot.nv;
  std::vector<double> states;
  FILE* file = std::fopen(argv[3], "rb");
  for (double x; file && std::fread(&x, sizeof x, 1, file) == 1;) states.push_back(x);
  const size_t count = states.size() / row;
  if (!count) return 2;

  std::vector<optimiser> all(optimisers, optimisers + optimiser_count);
  all.push_back({"torque derivatives", "Pinocchio", torque_derivatives, 0});
  all.push_back({"acceleration derivatives", "Pinocchio", acceleration_derivatives, 0});

  std::map<std::string, const optimiser*> first;
  bool right = true;
  for (const optimiser& one : all) {
    const optimiser* other = first.emplace(one.function, &one).first->second;
    std::vector<double> found(other->outputs), expected(other->outputs);
    double worst = 0;
    for (size_t k = 0; k < count; k++) {
      one.call(&states[k * row], found.data());
      if (!one.outputs) copy_results(one.function, found.data());
      other->call(&states[k * row], expected.data());
      double size = 0, error = 0;
      for (size_t i = 0; i < found.size(); i++) {
        size = std::max(size, std::abs(expected[i]));
        error = std::max(error, std::abs(found[i] - expected[i]));
      }
      worst = std::max(worst, error / size);
    }
    if (!(worst < 1e-9)) {
      std::fprintf(stderr, "%s: %s differs from %s by %g\n", one.function, one.name, other->name, worst);
      right = false;
    }
  }
  if (!right) return 1;

  const int repetitions = std::atoi(argv[4]), warm = 3;
  std::vector<std::vector<double>> times(all.size());
  std::vector<double> out(16384);
  for (int repetition = -warm; repetition < repetitions; repetition++)
    for (size_t c = 0; c < all.size(); c++) {
      const auto start = Clock::now();
      for (size_t k = 0; k < count; k++) all[c].call(&states[k * row], out.data());
      const std::chrono::duration<double, std::nano> time = Clock::now() - start;
      if (repetition >= 0) times[c].push_back(time.count() / count);
    }
  for (size_t c = 0; c < all.size(); c++) {
    std::nth_element(times[c].begin(), times[c].begin() + times[c].size() / 2, times[c].end());
    std::printf("%s,%s,%.1f\n", all[c].function, all[c].name, times[c][times[c].size() / 2]);
  }
}
