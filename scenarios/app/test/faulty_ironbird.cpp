// The program with estimators that misbehave half a second into the flight, to see what becomes of the run.

#include <csignal>
#include <cstdlib>
#include <stdexcept>

#include <unistd.h>

#include "autopilot/estimator/external_pose_estimator.hpp"
#include "autopilot/modules.hpp"
#include "scenarios/app/command_line.hpp"

namespace {

using ironbird::autopilot::Estimator;
using ironbird::autopilot::SensorFrame;
using ironbird::autopilot::StateEstimate;

constexpr ironbird::autopilot::Time kOnset = std::chrono::milliseconds(500);

enum class Fault { kThrows, kKilled, kCrashes, kLeaves, kHangs };

void commit(Fault fault) {
  switch (fault) {
    case Fault::kThrows:
      throw std::logic_error("the sky is falling");
    case Fault::kKilled:
      std::raise(SIGKILL);
      break;
    case Fault::kCrashes:
      std::signal(SIGSEGV, SIG_DFL);  // a sanitizer would make an exit of it
      std::raise(SIGSEGV);
      break;
    case Fault::kLeaves:
      _exit(0);
    case Fault::kHangs:
      for (;;) pause();
  }
}

template <Fault kFault>
class FaultyEstimator final : public Estimator {
 protected:
  StateEstimate estimate(const SensorFrame& frame, double) override {
    if (frame.imu.stamp > kOnset) commit(kFault);
    return {};
  }
};

}  // namespace

int main(int argc, char** argv) {
  ironbird::autopilot::Modules modules = ironbird::autopilot::standard_modules();
  modules.estimators.add<FaultyEstimator<Fault::kThrows>>("throws");
  modules.estimators.add<FaultyEstimator<Fault::kKilled>>("killed");
  modules.estimators.add<FaultyEstimator<Fault::kCrashes>>("crashes");
  modules.estimators.add<FaultyEstimator<Fault::kLeaves>>("leaves");
  modules.estimators.add<FaultyEstimator<Fault::kHangs>>("hangs");
  return ironbird::scenarios::run_command_line(argc, argv, modules);
}
