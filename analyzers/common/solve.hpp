// Small symmetric positive definite systems (normal equations) by Cholesky.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

namespace millscope::analyzers {

template <std::size_t n>
using Square = std::array<std::array<double, n>, n>;

/// Inverse of a symmetric positive definite matrix; nothing when it is singular to working precision (pivot below 1e-12 of its diagonal).
template <std::size_t n>
std::optional<Square<n>> inverse(const Square<n>& a) {
  Square<n> l{};
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = a[i][j];
      for (std::size_t k = 0; k < j; ++k) sum -= l[i][k] * l[j][k];
      if (i != j) {
        l[i][j] = sum / l[j][j];
      } else if (sum > 1e-12 * a[i][i]) {
        l[i][i] = std::sqrt(sum);
      } else {
        return std::nullopt;
      }
    }
  }
  Square<n> inverse{};
  for (std::size_t column = 0; column < n; ++column) {
    std::array<double, n> y{};
    for (std::size_t i = column; i < n; ++i) {
      double sum = i == column ? 1.0 : 0.0;
      for (std::size_t k = column; k < i; ++k) sum -= l[i][k] * y[k];
      y[i] = sum / l[i][i];
    }
    for (std::size_t i = n; i-- > 0;) {
      double sum = y[i];
      for (std::size_t k = i + 1; k < n; ++k) sum -= l[k][i] * inverse[k][column];
      inverse[i][column] = sum / l[i][i];
    }
  }
  return inverse;
}

template <std::size_t n>
std::array<double, n> product(const Square<n>& a, const std::array<double, n>& b) {
  std::array<double, n> x{};
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) x[i] += a[i][j] * b[j];
  }
  return x;
}

/// Solves a x = b; nothing when a is singular.
template <std::size_t n>
std::optional<std::array<double, n>> solve(const Square<n>& a, const std::array<double, n>& b) {
  const auto inverted = inverse(a);
  if (!inverted) return std::nullopt;
  return product(*inverted, b);
}

}  // namespace millscope::analyzers
