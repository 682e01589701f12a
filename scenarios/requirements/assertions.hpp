#pragma once

#include <memory>
#include <string>

#include "scenarios/requirements/check.hpp"

namespace ironbird::scenarios {

/// The key of the one kind that `config` gives. @throws std::invalid_argument when there is none, or more
std::string kind_of(const CheckConfig& config);

/// Makes the assertion of that kind. @throws std::invalid_argument naming the key that does not fit
std::unique_ptr<Assertion> make_assertion(const std::string& kind, const CheckConfig& config,
                                          const CheckContext& context);

}  // namespace ironbird::scenarios
