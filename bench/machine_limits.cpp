// What this machine can do at most, as JSON: memory bandwidth, multiply-adds, roots and quotients in double precision,
// on one core and on all. The yardstick for the share of the physical limit that a kernel reaches (bench/README.md).
#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <vector>

namespace {

constexpr int lanes = 8;  // of one vector: AVX-512; narrower units take it in parts
typedef double Lanes __attribute__((vector_size(lanes * sizeof(double))));
double volatile kept;  // so that no result is thrown away

/// Best of several trials of `work` on all threads at once [s].
template <class Work>
double fastest(int threads, Work const& work) {
  double best = 1e30;
  for (int trial = 0; trial < 5; ++trial) {
    auto const start = std::chrono::steady_clock::now();
#pragma omp parallel num_threads(threads)
    work();
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return best;
}

/// a = b + s c over arrays of so many bytes in all; 24 bytes an element are counted [B/s].
double triad(int threads, std::size_t bytes) {
  auto const n = bytes / 24 / static_cast<std::size_t>(threads);
  std::vector<std::vector<double>> arrays(static_cast<std::size_t>(3 * threads));
#pragma omp parallel num_threads(threads)
  for (int k = 0; k < 3; ++k) arrays[static_cast<std::size_t>(3 * omp_get_thread_num() + k)].assign(n, 1.0 + k);
  auto const repeats = std::max<std::size_t>(1, 200'000'000 / bytes);
  double const seconds = fastest(threads, [&] {
    auto const mine = static_cast<std::size_t>(3 * omp_get_thread_num());
    double *a = arrays[mine].data(), *b = arrays[mine + 1].data(), *c = arrays[mine + 2].data();
    for (std::size_t r = 0; r < repeats; ++r) {
#pragma omp simd
      for (std::size_t i = 0; i < n; ++i) a[i] = b[i] + 0.999 * c[i];
      kept = a[r % n];
    }
  });
  return static_cast<double>(24 * n * static_cast<std::size_t>(threads) * repeats) / seconds;
}

/// Multiply-adds in registers, two operations each [1/s].
double multiply_add(int threads) {
  constexpr int chains = 12;  // hide the latency of one behind the others
  constexpr std::int64_t repeats = 20'000'000;
  double const seconds = fastest(threads, [] {
    Lanes x[chains], factor, term;
    for (int l = 0; l < lanes; ++l) factor[l] = 1 - 1e-9 * l, term[l] = 1e-9 * l;
    for (int k = 0; k < chains; ++k) x[k] = term + k;
    for (std::int64_t r = 0; r < repeats; ++r)
      for (Lanes& value : x) value = value * factor + term;
    for (int k = 1; k < chains; ++k) x[0] += x[k];
    kept = x[0][0];
  });
  return 2.0 * lanes * chains * repeats * threads / seconds;
}

/// `of` on every element of an array that stays in the first-level cache [1/s].
template <class Function>
double elementwise(int threads, Function const& of) {
  constexpr std::size_t n = 1024;
  constexpr std::int64_t repeats = 50'000;
  double const seconds = fastest(threads, [&] {
    alignas(64) double values[n], results[n];
    for (std::size_t i = 0; i < n; ++i) values[i] = 1.5 + 1e-3 * static_cast<double>(i);
    for (std::int64_t r = 0; r < repeats; ++r) {
#pragma omp simd
      for (std::size_t i = 0; i < n; ++i) results[i] = of(values[i]);
      values[static_cast<std::size_t>(r) % n] += 1e-3 * results[static_cast<std::size_t>(r) % n];
    }
    kept = results[7];
  });
  return static_cast<double>(n) * repeats * threads / seconds;
}

void print(int threads, char const* end) {
  fmt::print("  {{\"threads\": {},\n", threads);
  for (auto const& [name, bytes] :
       {std::pair{"second_level_cache", std::size_t{1} << 20}, std::pair{"third_level_cache", std::size_t{24} << 20},
        std::pair{"memory", std::size_t{600} << 20}})
    fmt::print("   \"triad_bytes_per_second_{}\": {:.4g},\n", name, triad(threads, bytes));
  fmt::print("   \"flops_per_second\": {:.4g},\n", multiply_add(threads));
  fmt::print("   \"roots_per_second\": {:.4g},\n", elementwise(threads, [](double v) { return std::sqrt(v); }));
  fmt::print("   \"quotients_per_second\": {:.4g}}}{}\n", elementwise(threads, [](double v) { return 3.0 / v; }), end);
}

}  // namespace

int main() {
  int const cores = omp_get_num_procs();
  fmt::print("[\n");
  print(1, cores > 1 ? "," : "");
  if (cores > 1) print(cores, "");
  fmt::print("]\n");
}
