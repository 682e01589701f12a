#include "scenarios/app/reproducible_math.hpp"

#include <sleef.h>

// glibc chooses other implementations of these functions on processors with and without fused multiply-add,
// and their results differ in the last bit. The program therefore defines the names itself, over SLEEF's
// scalar functions, which give the same bits on every processor, and exports them, so that the calls of the
// physics engines land here too. Functions that IEEE 754 rounds correctly (sqrt, fmod, remainder, floor, ...)
// need none of this.
//
// Those that a tick calls are of the set with 3.5 units in the last place, which costs half of the set with
// one: an error of 1e-15 is nothing to a flight, and it is the same one everywhere.

extern "C" {

double tan(double x) noexcept {
  return Sleef_cinz_tand1_u35purec(x);
}
float tanf(float x) noexcept {
  return Sleef_cinz_tanf1_u35purec(x);
}
double asin(double x) noexcept {
  return Sleef_cinz_asind1_u35purec(x);
}
float asinf(float x) noexcept {
  return Sleef_cinz_asinf1_u35purec(x);
}
double acos(double x) noexcept {
  return Sleef_cinz_acosd1_u35purec(x);
}
float acosf(float x) noexcept {
  return Sleef_cinz_acosf1_u35purec(x);
}
double atan(double x) noexcept {
  return Sleef_cinz_atand1_u35purec(x);
}
float atanf(float x) noexcept {
  return Sleef_cinz_atanf1_u35purec(x);
}
double exp(double x) noexcept {
  return Sleef_cinz_expd1_u10purec(x);
}
float expf(float x) noexcept {
  return Sleef_cinz_expf1_u10purec(x);
}
double log(double x) noexcept {
  return Sleef_cinz_logd1_u35purec(x);
}
float logf(float x) noexcept {
  return Sleef_cinz_logf1_u35purec(x);
}
double sinh(double x) noexcept {
  return Sleef_cinz_sinhd1_u10purec(x);
}
float sinhf(float x) noexcept {
  return Sleef_cinz_sinhf1_u10purec(x);
}
double cosh(double x) noexcept {
  return Sleef_cinz_coshd1_u10purec(x);
}
float coshf(float x) noexcept {
  return Sleef_cinz_coshf1_u10purec(x);
}
double tanh(double x) noexcept {
  return Sleef_cinz_tanhd1_u10purec(x);
}
float tanhf(float x) noexcept {
  return Sleef_cinz_tanhf1_u10purec(x);
}
double cbrt(double x) noexcept {
  return Sleef_cinz_cbrtd1_u10purec(x);
}
float cbrtf(float x) noexcept {
  return Sleef_cinz_cbrtf1_u10purec(x);
}
double exp2(double x) noexcept {
  return Sleef_cinz_exp2d1_u10purec(x);
}
float exp2f(float x) noexcept {
  return Sleef_cinz_exp2f1_u10purec(x);
}
double log2(double x) noexcept {
  return Sleef_cinz_log2d1_u10purec(x);
}
float log2f(float x) noexcept {
  return Sleef_cinz_log2f1_u10purec(x);
}
double log10(double x) noexcept {
  return Sleef_cinz_log10d1_u10purec(x);
}
float log10f(float x) noexcept {
  return Sleef_cinz_log10f1_u10purec(x);
}
double expm1(double x) noexcept {
  return Sleef_cinz_expm1d1_u10purec(x);
}
float expm1f(float x) noexcept {
  return Sleef_cinz_expm1f1_u10purec(x);
}
double log1p(double x) noexcept {
  return Sleef_cinz_log1pd1_u10purec(x);
}
float log1pf(float x) noexcept {
  return Sleef_cinz_log1pf1_u10purec(x);
}
double pow(double x, double y) noexcept {
  return Sleef_cinz_powd1_u10purec(x, y);
}
float powf(float x, float y) noexcept {
  return Sleef_cinz_powf1_u10purec(x, y);
}
double atan2(double x, double y) noexcept {
  return Sleef_cinz_atan2d1_u35purec(x, y);
}
float atan2f(float x, float y) noexcept {
  return Sleef_cinz_atan2f1_u35purec(x, y);
}
double hypot(double x, double y) noexcept {
  return Sleef_cinz_hypotd1_u05purec(x, y);
}
float hypotf(float x, float y) noexcept {
  return Sleef_cinz_hypotf1_u05purec(x, y);
}

// An optimising compiler turns a sine and a cosine of the same angle into one sincos: all three must give the
// same bits.
double sin(double x) noexcept {
  return Sleef_cinz_sincosd1_u35purec(x).x;
}
double cos(double x) noexcept {
  return Sleef_cinz_sincosd1_u35purec(x).y;
}
float sinf(float x) noexcept {
  return Sleef_cinz_sincosf1_u35purec(x).x;
}
float cosf(float x) noexcept {
  return Sleef_cinz_sincosf1_u35purec(x).y;
}
void sincos(double x, double* sine, double* cosine) noexcept {
  const Sleef_double_2 both = Sleef_cinz_sincosd1_u35purec(x);
  *sine = both.x;
  *cosine = both.y;
}
void sincosf(float x, float* sine, float* cosine) noexcept {
  const Sleef_float_2 both = Sleef_cinz_sincosf1_u35purec(x);
  *sine = both.x;
  *cosine = both.y;
}
}

namespace ironbird::scenarios {

const char* reproducible_math() {
  return "SLEEF, scalar, at most 3.5 ulp";
}

}  // namespace ironbird::scenarios
