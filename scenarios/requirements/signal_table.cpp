#include "scenarios/requirements/signal_table.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "scenarios/config/nearest_name.hpp"
#include "scenarios/requirements/attitude.hpp"

namespace ironbird::scenarios {

namespace {

bool ends_with_name(std::string_view path, std::string_view name) {
  return path == name ||
         (path.size() > name.size() && path.ends_with(name) && path[path.size() - name.size() - 1] == '.');
}

template <double (*angle)(const Eigen::Quaterniond&)>
double read_angle(const void* address) {
  return angle(*static_cast<const Eigen::Quaterniond*>(address));
}

}  // namespace

double SignalLeaf::value() const {
  return present() ? read(address) : std::numeric_limits<double>::quiet_NaN();
}

bool Signal::is_angle() const {
  if (size_ != 1 || unit() != "rad") return false;
  return ends_with_name(path_, "roll") || ends_with_name(path_, "pitch") || ends_with_name(path_, "heading");
}

Eigen::Vector3d Signal::vector() const {
  Eigen::Vector3d out = Eigen::Vector3d::Zero();
  for (int i = 0; i < size_; ++i) out[i] = value(i);
  return out;
}

void SignalTable::add_leaf(SignalLeaf leaf) {
  if (by_path_.contains(leaf.path)) throw std::invalid_argument("signal " + leaf.path + " is listed twice");
  leaves_.push_back(std::move(leaf));
  by_path_.emplace(leaves_.back().path, &leaves_.back());
}

void SignalTable::add_attitude_angles() {
  using Reader = double (*)(const void*);
  const std::array<std::pair<const char*, Reader>, 3> angles{{{"roll", &read_angle<roll_of>},
                                                              {"pitch", &read_angle<pitch_of>},
                                                              {"heading", &read_angle<heading_of>}}};
  for (const SignalLeaf& attitude : attitudes_) {
    const std::string parent = attitude.path.substr(0, attitude.path.rfind('.') + 1);
    for (const auto& [name, read] : angles) {
      if (by_path_.contains(parent + name)) continue;
      SignalLeaf angle = attitude;
      angle.path = parent + name;
      angle.unit = "rad";
      angle.meaning = std::string("ZYX Euler angle of ") + attitude.path;
      angle.read = read;
      add_leaf(std::move(angle));
    }
  }
  attitudes_.clear();
}

void SignalTable::shorten(const std::string& path, std::size_t count, const std::string& reason) {
  for (std::size_t i = count;; ++i) {
    const std::string element = path + "[" + std::to_string(i) + "]";
    if (by_path_.erase(element) == 0) return;
    void_.emplace(element, reason);
  }
}

const SignalLeaf* SignalTable::leaf(std::string_view path) const {
  const auto found = by_path_.find(path);
  return found == by_path_.end() ? nullptr : found->second;
}

Signal SignalTable::find(std::string_view path) const {
  Signal signal;
  signal.path_ = path;
  if (const SignalLeaf* whole = leaf(path)) {
    signal.leaf_[0] = whole;
    signal.size_ = 1;
    return signal;
  }
  const bool is_quaternion = leaf(std::string(path) + ".w") != nullptr;
  for (const char* name : {".x", ".y", ".z"}) {
    const SignalLeaf* component = is_quaternion ? nullptr : leaf(std::string(path) + name);
    if (component == nullptr) break;
    signal.leaf_[static_cast<std::size_t>(signal.size_++)] = component;
  }
  if (signal.size_ > 0) return signal;

  if (const auto found = void_.find(path); found != void_.end())
    throw std::invalid_argument("no signal " + std::string(path) + "; " + found->second);
  std::vector<std::pair<std::size_t, std::string>> nearest;
  for (const SignalLeaf& candidate : leaves_) {
    if (void_.contains(candidate.path)) continue;
    nearest.emplace_back(edit_distance(path, candidate.path), candidate.path);
    const std::string whole = candidate.path.substr(0, candidate.path.size() - 2);
    const bool starts_vector = candidate.path.ends_with(".x") && leaf(whole + ".w") == nullptr;
    if (starts_vector) nearest.emplace_back(edit_distance(path, whole), whole);
  }
  std::sort(nearest.begin(), nearest.end());
  std::string message = "no signal " + std::string(path);
  for (std::size_t i = 0; i < std::min<std::size_t>(3, nearest.size()); ++i) {
    message += (i == 0 ? "; nearest: " : ", ") + nearest[i].second;
  }
  throw std::invalid_argument(message);
}

}  // namespace ironbird::scenarios
