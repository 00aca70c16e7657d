// Times all competitors of all plugins in one process, interleaved, and checks their results.
//
//   driver ROBOTS_DIR OUT.csv REPETITIONS ROBOT,ROBOT,... PLUGIN.so[=SUFFIX]...
//
// ROBOTS_DIR holds the files of prepare.py. SUFFIX is appended to the names of the plugin's competitors.
#include <dlfcn.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

#include "rnepeer.h"

namespace {

constexpr size_t STRETCH = 256;  // calls per timed stretch, short enough that a pre-emption spoils few samples
constexpr int WARM_UP = 3;       // repetitions before the first that counts
constexpr size_t MAX_JOINTS = 64;

struct Plugin {
  void* library;
  std::string suffix;
};

using Result = const double*(int, void*, const double*, int);
using Keep = void(int, void*, int);

struct Peer {
  std::string name;
  int index, kind;
  void* function;
  void* context;
  Result* result;  // null where the plugin has no rp_result
  Keep* keep;      // null where it has no rp_keep
  std::vector<double> independent, chained;  // ns per state, one sample per stretch
  double error = NAN;                        // largest deviation from the reference over its largest value
  bool is_batch() const { return kind >= RP_ID_BATCH; }
};

// The states of a robot and their reference torques, as [state][joint] and as structure of arrays [joint][state], and
// the other references, one state after the other.
struct States {
  size_t joints = 0, count = 0;
  double *q, *qd, *qdd, *tau;
  double *soa_q, *soa_qd, *soa_qdd, *soa_tau;
  double* references[RP_QUANTITIES];
  double largest_qdd = 0, largest[RP_QUANTITIES];
  // Numbers per state.
  size_t size_of(int what) const { return what < RP_MASS_MATRIX ? joints : joints * joints; }
};

[[noreturn]] void fail(const std::string& message) {
  std::fprintf(stderr, "driver: %s\n", message.c_str());
  std::exit(2);
}

double now() {
  return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double* array(size_t count) {
  void* memory = nullptr;
  if (posix_memalign(&memory, 64, count * sizeof(double) + 64)) fail("out of memory");
  std::memset(memory, 0, count * sizeof(double) + 64);
  return static_cast<double*>(memory);
}

double median(std::vector<double> values) {
  if (values.empty()) return NAN;
  auto middle = values.begin() + values.size() / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double minimum(const std::vector<double>& values) {
  return values.empty() ? NAN : *std::min_element(values.begin(), values.end());
}

double largest(const double* values, size_t count) {
  double result = 0;
  for (size_t i = 0; i < count; i++) result = std::max(result, std::fabs(values[i]));
  return result;
}

// The largest difference; NaN as soon as one result is NaN.
double deviation(const double* result, const double* reference, size_t count) {
  double worst = 0;
  for (size_t i = 0; i < count; i++) {
    double difference = std::fabs(result[i] - reference[i]);
    if (!(difference <= worst)) worst = difference;
    if (std::isnan(worst)) return INFINITY;
  }
  return worst;
}

States read_states(const std::string& file) {
  FILE* f = std::fopen(file.c_str(), "rb");
  if (!f) fail("cannot read " + file);
  int64_t header[2];
  if (std::fread(header, sizeof header[0], 2, f) != 2) fail(file + " is too short");
  States s;
  s.joints = size_t(header[0]), s.count = size_t(header[1]);
  if (s.joints > MAX_JOINTS || s.count % STRETCH) fail(file + ": sizes");
  const size_t size = s.joints * s.count;
  double** rows[] = {&s.q, &s.qd, &s.qdd, &s.tau};
  double** columns[] = {&s.soa_q, &s.soa_qd, &s.soa_qdd, &s.soa_tau};
  for (int i = 0; i < 4; i++) {
    *rows[i] = array(size), *columns[i] = array(size);
    if (std::fread(*rows[i], sizeof(double), size, f) != size) fail(file + " is too short");
    for (size_t k = 0; k < s.count; k++)
      for (size_t j = 0; j < s.joints; j++) (*columns[i])[j * s.count + k] = (*rows[i])[k * s.joints + j];
  }
  s.references[RP_TAU] = s.tau;
  for (int what = RP_TAU; what < RP_QUANTITIES; what++) {
    const size_t numbers = s.size_of(what) * s.count;
    if (what != RP_TAU) {
      s.references[what] = array(numbers);
      if (std::fread(s.references[what], sizeof(double), numbers, f) != numbers) fail(file + " is too short");
    }
    s.largest[what] = largest(s.references[what], numbers);
  }
  std::fclose(f);
  s.largest_qdd = largest(s.qdd, size);
  return s;
}

template <class F>
F* symbol(void* library, const char* name) {
  void* address = dlsym(library, name);
  if (!address) fail(dlerror());
  return reinterpret_cast<F*>(address);
}

std::vector<Peer> peers_of(const std::vector<Plugin>& plugins, const std::string& robot, const std::string& dir) {
  std::vector<Peer> peers;
  for (const Plugin& plugin : plugins) {
    const int count = symbol<int()>(plugin.library, "rp_count")();
    for (int k = 0; k < count; k++) {
      void* function = symbol<void*(int, const char*)>(plugin.library, "rp_func")(k, robot.c_str());
      if (!function) continue;
      Peer peer;
      peer.name = symbol<const char*(int)>(plugin.library, "rp_name")(k) + plugin.suffix;
      peer.index = k;
      peer.kind = symbol<int(int)>(plugin.library, "rp_kind")(k);
      peer.result = reinterpret_cast<Result*>(dlsym(plugin.library, "rp_result"));
      peer.keep = reinterpret_cast<Keep*>(dlsym(plugin.library, "rp_keep"));
      peer.function = function;
      const auto open = symbol<void*(int, const char*, const char*)>(plugin.library, "rp_open");
      peer.context = open(k, robot.c_str(), dir.c_str());
      peers.push_back(peer);
    }
  }
  return peers;
}

// All quantities that a competitor says it computes; each deviation is over the largest value of its quantity.
void check_results(Peer& peer, const States& s, double* out) {
  if (!peer.result) return;
  for (size_t k = 0; k < s.count; k++) {
    const size_t i = k * s.joints;
    rp_call(peer.function)(peer.context, s.q + i, s.qd + i, s.qdd + i, out);
    for (int what = RP_TAU; what < RP_QUANTITIES; what++) {
      const double* result = peer.result(peer.index, peer.context, out, what);
      if (!result) continue;
      const size_t size = s.size_of(what);
      const double error = deviation(result, s.references[what] + k * size, size) / s.largest[what];
      peer.error = std::isnan(peer.error) ? error : std::max(peer.error, error);
    }
  }
}

// The same of many states in one call.
void check_batch_results(Peer& peer, const States& s, double* out) {
  rp_batch(peer.function)(peer.context, s.soa_q, s.soa_qd, s.soa_qdd, out, s.count);
  for (int what = RP_TAU; peer.result && what < RP_QUANTITIES; what++) {
    const double* result = peer.result(peer.index, peer.context, out, what);
    if (!result) continue;
    const size_t size = s.size_of(what);
    std::vector<double> rows(size * s.count);
    for (size_t k = 0; k < s.count; k++)
      for (size_t e = 0; e < size; e++) rows[k * size + e] = result[e * s.count + k];
    const double error = deviation(rows.data(), s.references[what], rows.size()) / s.largest[what];
    peer.error = std::isnan(peer.error) ? error : std::max(peer.error, error);
  }
}

void check_kind(Peer& peer, const States& s, double* out) {
  if (peer.kind == RP_OTHER_BATCH) return check_batch_results(peer, s, out);
  if (peer.kind == RP_OTHER) return check_results(peer, s, out);
  const size_t size = s.joints * s.count;
  std::fill(out, out + size, NAN);
  if (peer.is_batch()) {
    const bool forward = peer.kind == RP_FD_BATCH;
    rp_batch(peer.function)(peer.context, s.soa_q, s.soa_qd, forward ? s.soa_tau : s.soa_qdd, out, s.count);
    peer.error = forward ? deviation(out, s.soa_qdd, size) / s.largest_qdd
                         : deviation(out, s.soa_tau, size) / s.largest[RP_TAU];
    return;
  }
  const bool forward = peer.kind == RP_FD;
  for (size_t i = 0; i < size; i += s.joints)
    rp_call(peer.function)(peer.context, s.q + i, s.qd + i, (forward ? s.tau : s.qdd) + i, out + i);
  peer.error =
      forward ? deviation(out, s.qdd, size) / s.largest_qdd : deviation(out, s.tau, size) / s.largest[RP_TAU];
}

void check(Peer& peer, const States& s, double* out) {
  if (peer.keep) peer.keep(peer.index, peer.context, 1);
  check_kind(peer, s, out);
  if (peer.keep) peer.keep(peer.index, peer.context, 0);
}

void time_batch(Peer& peer, const States& s, double* out, bool counts) {
  const auto call = rp_batch(peer.function);
  const double start = now();
  call(peer.context, s.soa_q, s.soa_qd, peer.kind == RP_FD_BATCH ? s.soa_tau : s.soa_qdd, out, s.count);
  const double end = now();
  if (counts) peer.independent.push_back((end - start) / double(s.count));
}

void time_calls(Peer& peer, const States& s, double* out, bool counts) {
  const auto call = rp_call(peer.function);
  const size_t n = s.joints;
  const double* third = peer.kind == RP_FD ? s.tau : s.qdd;
  // Independent: the processor may overlap one call with the next.
  for (size_t first = 0; first < s.count; first += STRETCH) {
    const double start = now();
    for (size_t k = first; k < first + STRETCH; k++)
      call(peer.context, s.q + k * n, s.qd + k * n, third + k * n, out + k * n);
    const double end = now();
    if (counts) peer.independent.push_back((end - start) / STRETCH);
  }
  // Chained: every q depends on the results of the call before, by far less than rounding.
  double q[MAX_JOINTS], last[MAX_JOINTS] = {0};
  for (size_t first = 0; first < s.count; first += STRETCH) {
    const double start = now();
    for (size_t k = first; k < first + STRETCH; k++) {
      for (size_t j = 0; j < n; j++) q[j] = s.q[k * n + j] + 1e-30 * last[j];
      call(peer.context, q, s.qd + k * n, third + k * n, last);
    }
    const double end = now();
    if (counts) peer.chained.push_back((end - start) / STRETCH);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 6) fail("usage: driver ROBOTS_DIR OUT.csv REPETITIONS ROBOT,ROBOT,... PLUGIN.so[=SUFFIX]...");
  const std::string dir = argv[1];
  const int repetitions = std::atoi(argv[3]);
  if (repetitions < 1) fail("at least one repetition");

  std::vector<Plugin> plugins;
  for (int i = 5; i < argc; i++) {
    const std::string argument = argv[i];
    const size_t equals = argument.rfind('=');
    const std::string file = argument.substr(0, equals);
    void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library) fail(dlerror());
    plugins.push_back({library, equals == std::string::npos ? "" : argument.substr(equals + 1)});
  }

  FILE* csv = std::fopen(argv[2], "w");
  if (!csv) fail(std::string("cannot write ") + argv[2]);
  std::fprintf(csv, "robot,peer,kind,independent_median,independent_min,chained_median,chained_min,error\n");
  const bool terminal = isatty(STDERR_FILENO);
  std::stringstream robots(argv[4]);
  for (std::string robot; std::getline(robots, robot, ',');) {
    const States states = read_states(dir + "/" + robot + ".states");
    std::vector<Peer> peers = peers_of(plugins, robot, dir);
    double* out = array(states.count * MAX_JOINTS);
    for (Peer& peer : peers) check(peer, states, out);
    for (int r = -WARM_UP; r < repetitions; r++) {
      if (terminal)
        std::fprintf(stderr, "\r\033[K   %s: %d of %d repetitions", robot.c_str(), std::max(r, 0), repetitions);
      for (Peer& peer : peers) {
        if (peer.is_batch())
          time_batch(peer, states, out, r >= 0);
        else
          time_calls(peer, states, out, r >= 0);
      }
    }
    for (const Peer& peer : peers)
      std::fprintf(csv, "%s,%s,%d,%.3f,%.3f,%.3f,%.3f,%.1e\n", robot.c_str(), peer.name.c_str(), peer.kind,
                   median(peer.independent), minimum(peer.independent), median(peer.chained), minimum(peer.chained),
                   peer.error);
    std::fflush(csv);
  }
  if (terminal) std::fprintf(stderr, "\r\033[K");
  if (std::fclose(csv)) fail("writing failed");
}
