// SPDX-License-Identifier: GPL-3.0-or-later
/// What a reach is predicted from, as the columns of a regression (Faraway, Reed, Wang 2007, section 3.3).
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "reachcast/conventions.hpp"

namespace reachcast {

enum class CovariateKind { number, label, vector };  ///< in the order of the variant below

/// One value per reach: a number (stature, age, duration), a label (object, sex, subject) or a vector in the body frame
/// of a right hand (target, shoulder).
struct Covariate {
  std::string name;
  std::variant<std::vector<double>, std::vector<std::string>, Points> values;

  [[nodiscard]] std::size_t count() const;
  [[nodiscard]] CovariateKind kind() const;
};

/// The columns that belong to one covariate.
struct Term {
  std::string name;
  CovariateKind kind = CovariateKind::number;
  std::vector<std::string> levels;  ///< of labels, sorted
  Eigen::Index first = 0;
  Eigen::Index count = 0;
};

/// How covariates become columns: a number is one, a vector three; a label one per level but the first in alphabetical
/// order, which the intercept stands for. With `quadratic`, squares (and a vector's mixed products) follow the numbers
/// and vectors of the same term. There is no column for the intercept.
class Design {
 public:
  Design() = default;
  /// Learns names, kinds and levels. Throws std::invalid_argument for a name given twice, and for labels without a
  /// second level.
  explicit Design(std::span<const Covariate> covariates, bool quadratic = false);

  /// reaches x columns; covariates in any order. Throws std::invalid_argument naming a covariate that is missing,
  /// unknown, of another kind or length, or not finite, and a level that the data did not have.
  [[nodiscard]] Eigen::MatrixXd rows(std::span<const Covariate> covariates, std::size_t reaches) const;

  [[nodiscard]] const std::vector<Term>& terms() const { return terms_; }
  /// For messages and tables: "stature", "target_x", "target_x*target_z", "sex=male".
  [[nodiscard]] const std::vector<std::string>& column_names() const { return names_; }
  [[nodiscard]] Eigen::Index columns() const { return static_cast<Eigen::Index>(names_.size()); }

 private:
  void add_term(const Covariate& covariate);
  void fill(const Covariate& covariate, const Term& term, Eigen::MatrixXd& rows) const;

  bool quadratic_ = false;
  std::vector<Term> terms_;
  std::vector<std::string> names_;
};

}  // namespace reachcast
