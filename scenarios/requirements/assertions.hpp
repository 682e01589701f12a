#pragma once

#include <memory>
#include <string>

#include "scenarios/requirements/check.hpp"

namespace ironbird::scenarios {

/// The key of the one kind that `config` gives. @throws std::invalid_argument when there is none, or more
std::string kind_of(const CheckConfig& config);

/// Does a check of this kind say something of every moment of its window, so that its end must have come? The
/// others are shown by one moment.
bool is_about_all_of_its_window(const std::string& kind);

/// Makes the assertion of that kind. @throws std::invalid_argument naming the key that does not fit
std::unique_ptr<Assertion> make_assertion(const std::string& kind, const CheckConfig& config,
                                          const CheckContext& context);

}  // namespace ironbird::scenarios
