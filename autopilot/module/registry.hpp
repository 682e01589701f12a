#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace ironbird::autopilot {

/// Makes modules of one interface by the name of their kind.
template <class Base>
class Registry {
 public:
  using Factory = std::function<std::unique_ptr<Base>()>;

  /// Registers `Kind` under `name`; a second registration of a name replaces the first.
  template <class Kind>
  void add(const std::string& name) {
    factories_[name] = [] { return std::make_unique<Kind>(); };
  }

  /// A new module, or null when no kind has that name.
  std::unique_ptr<Base> make(const std::string& name) const {
    const auto found = factories_.find(name);
    return found == factories_.end() ? nullptr : found->second();
  }

  /// The names of all kinds, sorted.
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& [name, factory] : factories_) names.push_back(name);
    return names;
  }

 private:
  std::map<std::string, Factory> factories_;
};

}  // namespace ironbird::autopilot
