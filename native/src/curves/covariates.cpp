// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/curves/covariates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace reachcast {

namespace {

constexpr std::array<const char*, 3> kKinds{"numbers", "labels", "vectors"};
constexpr std::array<const char*, 3> kAxes{"_x", "_y", "_z"};

[[noreturn]] void refuse(const std::string& name, const std::string& what) {
  throw std::invalid_argument("covariates['" + name + "'] " + what);
}

std::vector<std::string> levels_of(const Covariate& covariate) {
  const auto* labels = std::get_if<std::vector<std::string>>(&covariate.values);
  if (!labels) return {};
  std::vector<std::string> levels = *labels;
  std::sort(levels.begin(), levels.end());
  levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
  if (levels.size() < 2) refuse(covariate.name, "has fewer than 2 different labels, so nothing to compare");
  return levels;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

/// The numbers of one value, then their squares and products when asked for.
Eigen::RowVectorXd expanded(const Eigen::RowVectorXd& value, bool quadratic) {
  if (!quadratic) return value;
  const Eigen::Index n = value.size();
  Eigen::RowVectorXd row(n + n * (n + 1) / 2);
  row.head(n) = value;
  Eigen::Index next = n;
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = i; j < n; ++j) row[next++] = value[i] * value[j];
  }
  return row;
}

}  // namespace

std::size_t Covariate::count() const {
  return std::visit([](const auto& list) { return list.size(); }, values);
}

CovariateKind Covariate::kind() const {
  return static_cast<CovariateKind>(values.index());
}

Design::Design(std::span<const Covariate> covariates, bool quadratic) : quadratic_(quadratic) {
  for (const Covariate& covariate : covariates) {
    for (const Term& term : terms_) {
      if (term.name == covariate.name) refuse(covariate.name, "is given twice");
    }
    add_term(covariate);
  }
}

void Design::add_term(const Covariate& covariate) {
  const Eigen::Index first = columns();
  const std::vector<std::string> levels = levels_of(covariate);
  for (std::size_t i = 1; i < levels.size(); ++i) names_.push_back(covariate.name + "=" + levels[i]);
  if (levels.empty()) {
    std::vector<std::string> base{covariate.name};
    if (std::holds_alternative<Points>(covariate.values)) {
      base.clear();
      for (const char* axis : kAxes) base.push_back(covariate.name + axis);
    }
    names_.insert(names_.end(), base.begin(), base.end());
    for (std::size_t i = 0; quadratic_ && i < base.size(); ++i) {
      for (std::size_t j = i; j < base.size(); ++j) names_.push_back(base[i] + "*" + base[j]);
    }
  }
  terms_.push_back({covariate.name, covariate.kind(), levels, first, columns() - first});
}

Eigen::MatrixXd Design::rows(std::span<const Covariate> covariates, std::size_t reaches) const {
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(reaches), columns());
  std::vector<bool> found(terms_.size(), false);
  for (const Covariate& covariate : covariates) {
    const auto same = [&](const Term& term) { return term.name == covariate.name; };
    const auto at = std::find_if(terms_.begin(), terms_.end(), same);
    if (at == terms_.end()) refuse(covariate.name, "is not among those that the model was fitted with");
    const auto term = static_cast<std::size_t>(at - terms_.begin());
    if (found[term]) refuse(covariate.name, "is given twice");
    found[term] = true;
    if (covariate.count() != reaches) {
      refuse(covariate.name, "has " + std::to_string(covariate.count()) + " values, expected " +
                                 std::to_string(reaches) + ", one per reach");
    }
    fill(covariate, *at, rows);
  }
  for (std::size_t term = 0; term < terms_.size(); ++term) {
    if (!found[term]) refuse(terms_[term].name, "is missing, the model was fitted with it");
  }
  return rows;
}

void Design::fill(const Covariate& covariate, const Term& term, Eigen::MatrixXd& rows) const {
  if (covariate.kind() != term.kind) {
    refuse(covariate.name, std::string("holds ") + kKinds[covariate.values.index()] + ", expected " +
                               kKinds[static_cast<std::size_t>(term.kind)]);
  }
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (const auto* labels = std::get_if<std::vector<std::string>>(&covariate.values)) {
      const auto level = std::lower_bound(term.levels.begin(), term.levels.end(), (*labels)[k]);
      if (level == term.levels.end() || *level != (*labels)[k]) {
        refuse(covariate.name, "has the label '" + (*labels)[k] + "', expected one of " + joined(term.levels));
      }
      if (level != term.levels.begin()) rows(i, term.first + (level - term.levels.begin()) - 1) = 1.0;
      continue;
    }
    Eigen::RowVectorXd value(1);
    if (const auto* points = std::get_if<Points>(&covariate.values)) {
      value = to_eigen((*points)[k]).transpose();
    } else {
      value[0] = std::get<std::vector<double>>(covariate.values)[k];
    }
    if (!value.allFinite()) refuse(covariate.name, "is not finite for reach " + std::to_string(k));
    rows.row(i).segment(term.first, term.count) = expanded(value, quadratic_);
  }
}

}  // namespace reachcast
