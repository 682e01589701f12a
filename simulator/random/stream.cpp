#include "simulator/random/stream.hpp"

#include <array>
#include <cmath>

namespace ironbird::simulator {

namespace {

constexpr std::uint64_t kGoldenRatio = 0x9E3779B97F4A7C15u;

std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return z ^ (z >> 31);
}

using Coefficients = std::array<double, 8>;

/// A polynomial of seventh degree, highest power first. Its parts do not wait for each other as in Horner's
/// rule, which takes a fifth off the cost of a deviate.
double polynomial(const Coefficients& c, double x) {
  const double x2 = x * x;
  const double x4 = x2 * x2;
  const double high = (c[0] * x + c[1]) * x2 + (c[2] * x + c[3]);
  const double low = (c[4] * x + c[5]) * x2 + (c[6] * x + c[7]);
  return high * x4 + low;
}

// Coefficients of AS 241, routine PPND16, highest power first: numerator and denominator for the centre, the
// shoulders, the tails.
constexpr Coefficients kCentreTop = {
    2.5090809287301226727e+3, 3.3430575583588128105e+4, 6.7265770927008700853e+4, 4.5921953931549871457e+4,
    1.3731693765509461125e+4, 1.9715909503065514427e+3, 1.3314166789178437745e+2, 3.3871328727963666080e+0};
constexpr Coefficients kCentreBottom = {
    5.2264952788528545610e+3, 2.8729085735721942674e+4, 3.9307895800092710610e+4, 2.1213794301586595867e+4,
    5.3941960214247511077e+3, 6.8718700749205790830e+2, 4.2313330701600911252e+1, 1.0};
constexpr Coefficients kShoulderTop = {7.74545014278341407640e-4, 2.27238449892691845833e-2,
                                       2.41780725177450611770e-1, 1.27045825245236838258e+0,
                                       3.64784832476320460504e+0, 5.76949722146069140550e+0,
                                       4.63033784615654529590e+0, 1.42343711074968357734e+0};
constexpr Coefficients kShoulderBottom = {1.05075007164441684324e-9, 5.47593808499534494600e-4,
                                          1.51986665636164571966e-2, 1.48103976427480074590e-1,
                                          6.89767334985100004550e-1, 1.67638483018380384940e+0,
                                          2.05319162663775882187e+0, 1.0};
constexpr Coefficients kTailTop = {2.01033439929228813265e-7, 2.71155556874348757815e-5,
                                   1.24266094738807843860e-3, 2.65321895265761230930e-2,
                                   2.96560571828504891230e-1, 1.78482653991729133580e+0,
                                   5.46378491116411436990e+0, 6.65790464350110377720e+0};
constexpr Coefficients kTailBottom = {2.04426310338993978564e-15, 1.42151175831644588870e-7,
                                      1.84631831751005468180e-5,  7.86869131145613259100e-4,
                                      1.48753612908506148525e-2,  1.36929880922735805310e-1,
                                      5.99832206555887937690e-1,  1.0};

}  // namespace

Stream::Stream(std::uint64_t seed, std::string_view name) {
  // FNV-1a over the name, then mixed with the seed.
  std::uint64_t hash = 0xCBF29CE484222325u;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3u;
  state_ = mix(mix(seed + kGoldenRatio) ^ hash);
}

double Stream::uniform() {
  state_ += kGoldenRatio;
  // 53 bits, moved by half a step so that neither 0 nor 1 occurs.
  return (static_cast<double>(mix(state_) >> 11) + 0.5) * 0x1.0p-53;
}

double Stream::normal() {
  return normal_quantile(uniform());
}

double normal_quantile(double p) {
  const double q = p - 0.5;
  if (std::abs(q) <= 0.425) {
    const double r = 0.180625 - q * q;
    return q * polynomial(kCentreTop, r) / polynomial(kCentreBottom, r);
  }
  const double r = std::sqrt(-std::log(q < 0.0 ? p : 1.0 - p));
  const double x = r <= 5.0 ? polynomial(kShoulderTop, r - 1.6) / polynomial(kShoulderBottom, r - 1.6)
                            : polynomial(kTailTop, r - 5.0) / polynomial(kTailBottom, r - 5.0);
  return q < 0.0 ? -x : x;
}

}  // namespace ironbird::simulator
