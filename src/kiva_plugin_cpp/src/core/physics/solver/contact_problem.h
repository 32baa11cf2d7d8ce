// SPDX-License-Identifier: Apache-2.0
//
// Rigid contacts of one mechanism with the ground: the impulses that keep them from sinking in and,
// within Coulomb's friction, from slipping.
#pragma once

#include <array>

namespace kiva {

/// Rows are directions at contacts: a contact has one along its normal and, if it has friction, two
/// along the ground behind it. Impulses x [N s] change the rows' velocities [m/s] to a x + b.
class ContactProblem {
 public:
  static constexpr int kMaxContacts = 8;
  static constexpr int kMaxRows = 3 * kMaxContacts;

  int rows() const { return rows_; }
  int contacts() const { return contacts_; }
  bool hasFriction(int contact) const { return friction_[contact] > 0; }

  /// Appends a contact; the caller then fills its rows of `a` and `b`.
  void add(double friction);

  /// Computes x so that at every contact along the normal a x + b >= 0, x >= 0, and one of both is
  /// zero; along the ground a x + b = 0, unless that takes more than friction · x_normal.
  /// Contacts that hold are solved directly. If one slips or is about to lift off, projected
  /// Gauss-Seidel (Jourdan, Alart, Jean 1998) continues from there.
  void solve();

  std::array<std::array<double, kMaxRows>, kMaxRows> a;  ///< Symmetric [1/kg]; both halves.
  std::array<double, kMaxRows> b;
  std::array<double, kMaxRows> x;

 private:
  bool solveHolding();
  bool holdWithinFriction() const;
  void solveActive(const int* active, int count);
  double residual(int row) const;
  bool isWithinFriction(int contact) const;
  void iterate();
  double sweep();
  double relaxFriction(int contact);

  int rows_ = 0, contacts_ = 0;
  std::array<int, kMaxContacts> first_;
  std::array<double, kMaxContacts> friction_;
};

}  // namespace kiva
