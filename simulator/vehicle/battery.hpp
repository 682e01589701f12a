#pragma once

#include <array>

namespace ironbird::simulator {

/// A pack of equal cells in series.
struct BatteryParams {
  double constant_voltage = 0.0;
  int cells = 6;
  double capacity = 36000.0;
  double initial_charge = 1.0;
  double resistance = 0.0;
  std::array<double, 11> cell_voltage = {3.27, 3.61, 3.69, 3.71, 3.75, 3.79, 3.83, 3.91, 3.98, 4.08, 4.2};
  double collapse = 0.01;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("constant_voltage", self.constant_voltage, "V",
          "> 0: an ideal source of this voltage, nothing else counts", 0.0, 1000.0);
    visit("cells", self.cells, "1", "in series", 1.0, 100.0);
    visit("capacity", self.capacity, "A*s", "charge of a full pack", 1.0, 1e8);
    visit("initial_charge", self.initial_charge, "1", "share of the capacity at the start", 0.0, 1.0);
    visit("resistance", self.resistance, "ohm", "of the whole pack and its leads", 0.0, 10.0);
    visit("cell_voltage", self.cell_voltage, "V", "open-circuit voltage of a cell at charge 0, 0.1, .. 1",
          0.1, 10.0);
    visit("collapse", self.collapse, "1",
          "share of the capacity that is left at charge 0, and over which the voltage falls to nothing", 1e-4,
          0.2);
  }
};

/// Open-circuit voltage from the charge left, less the drop over the internal resistance.
///
/// Charge 0 is where a discharge should have ended, at about 3.3 V a cell. Beyond it the curve of a
/// lithium-polymer cell falls off a cliff: here in a straight line to 0 V within `collapse` of the capacity,
/// estimated. No recovery after load, no temperature. Current flowing back from braking rotors is not stored.
class Battery {
 public:
  Battery() = default;
  explicit Battery(const BatteryParams& params);

  /// Terminals open, V.
  double open_voltage() const { return open_voltage_; }
  /// ohm.
  double resistance() const { return resistance_; }
  /// Drawn since the start, A*s.
  double charge_used() const { return charge_used_; }

  /// Draws `current`, A, for `dt`, s.
  void draw(double current, double dt);

  /// From now on `fraction`, 0..1, of the capacity is left; what was drawn stays counted.
  void set_charge(double fraction);

 private:
  void find_open_voltage();

  BatteryParams params_;
  double charge_ = 1.0;  // share of the capacity
  double charge_used_ = 0.0;
  double open_voltage_ = 0.0;
  double resistance_ = 0.0;
};

}  // namespace ironbird::simulator
