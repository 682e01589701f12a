// Any bytes as a sensor frame or a request in a run's log: they are refused in one line, or read; what is
// read comes out the same when it is written and read again.

#include <algorithm>
#include <span>
#include <string>

#include "autopilot/types/sensor_frame.hpp"
#include "ci/fuzzing/harness.hpp"
#include "scenarios/bench/logged_request.hpp"
#include "scenarios/config/user_error.hpp"
#include "scenarios/record/cdr.hpp"
#include "scenarios/record/cdr_decoder.hpp"

namespace ironbird::fuzzing {

namespace {

using scenarios::ByteBuffer;
using scenarios::decode_cdr;
using scenarios::LoggedRequest;

template <class T>
ByteBuffer written(const T& value) {
  ByteBuffer out;
  scenarios::encode_cdr(value, out);
  return out;
}

template <class T>
bool same(const T& one, const T& other) {
  const ByteBuffer a = written(one);
  const ByteBuffer b = written(other);
  return std::equal(a.bytes().begin(), a.bytes().end(), b.bytes().begin(), b.bytes().end());
}

template <class T>
T read_twice(std::span<const std::uint8_t> message) {
  const T value = decode_cdr<T>(message);
  require(same(value, decode_cdr<T>(written(value).bytes())), "what was read is read again");
  return value;
}

void check_request(std::span<const std::uint8_t> message) {
  const auto request = read_twice<LoggedRequest>(message);
  const LoggedRequest again =
      scenarios::logged(scenarios::request_of(request), {request.accepted, request.reason, {}});
  require(again.kind == request.kind, "a request is of the kind that was logged");
}

}  // namespace

void check(std::span<const std::uint8_t> input) {
  if (input.empty()) return;
  const bool is_request = (input.front() & 1U) != 0;
  const auto message = input.subspan(1);
  try {
    if (is_request) {
      check_request(message);
    } else {
      read_twice<autopilot::SensorFrame>(message);
    }
  } catch (const scenarios::UserError& error) {
    require(std::string(error.what()).find('\n') == std::string::npos, "a refusal is one line");
  }
}

}  // namespace ironbird::fuzzing
