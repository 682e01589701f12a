#include "scenarios/app/products.hpp"

namespace ironbird::scenarios {

void make_products(const RunJob&, const Verdict&, const Terminal&) {}

}  // namespace ironbird::scenarios
