// Three-component vectors for host and device.
#pragma once

#include <Kokkos_Macros.hpp>
#include <cmath>

#include "core/types.hpp"

namespace pellicle {

/// Three components of type T; an aggregate, so that Vec3{x, y, z} works on host and device.
template <class T>
struct Vector3 {
  T x{}, y{}, z{};

  KOKKOS_INLINE_FUNCTION constexpr T& operator[](int axis) { return axis == 0 ? x : (axis == 1 ? y : z); }
  KOKKOS_INLINE_FUNCTION constexpr const T& operator[](int axis) const {
    return axis == 0 ? x : (axis == 1 ? y : z);
  }
  KOKKOS_INLINE_FUNCTION constexpr Vector3& operator+=(const Vector3& b) {
    x += b.x;
    y += b.y;
    z += b.z;
    return *this;
  }
  KOKKOS_INLINE_FUNCTION constexpr Vector3& operator-=(const Vector3& b) {
    x -= b.x;
    y -= b.y;
    z -= b.z;
    return *this;
  }
  KOKKOS_INLINE_FUNCTION constexpr Vector3& operator*=(T s) {
    x *= s;
    y *= s;
    z *= s;
    return *this;
  }
  friend KOKKOS_INLINE_FUNCTION constexpr bool operator==(const Vector3& a, const Vector3& b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
  }
};

template <class T>
KOKKOS_INLINE_FUNCTION constexpr Vector3<T> operator+(Vector3<T> a, const Vector3<T>& b) {
  return a += b;
}
template <class T>
KOKKOS_INLINE_FUNCTION constexpr Vector3<T> operator-(Vector3<T> a, const Vector3<T>& b) {
  return a -= b;
}
template <class T>
KOKKOS_INLINE_FUNCTION constexpr Vector3<T> operator-(const Vector3<T>& a) {
  return {-a.x, -a.y, -a.z};
}
template <class T>
KOKKOS_INLINE_FUNCTION constexpr Vector3<T> operator*(Vector3<T> a, T s) {
  return a *= s;
}
template <class T>
KOKKOS_INLINE_FUNCTION constexpr Vector3<T> operator*(T s, Vector3<T> a) {
  return a *= s;
}
template <class T>
KOKKOS_INLINE_FUNCTION constexpr T dot(const Vector3<T>& a, const Vector3<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
KOKKOS_INLINE_FUNCTION constexpr Vector3<T> cross(const Vector3<T>& a, const Vector3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
KOKKOS_INLINE_FUNCTION constexpr T norm_squared(const Vector3<T>& a) {
  return dot(a, a);
}
template <class T>
KOKKOS_INLINE_FUNCTION T norm(const Vector3<T>& a) {
  return std::sqrt(dot(a, a));
}

/// A unit vector at right angles to a unit vector.
template <class T>
KOKKOS_INLINE_FUNCTION Vector3<T> perpendicular_to(const Vector3<T>& a) {
  const Vector3<T> other = a.x < T(0.6) && a.x > T(-0.6) ? Vector3<T>{1, 0, 0} : Vector3<T>{0, 1, 0};
  const Vector3<T> p = cross(a, other);
  return (1 / norm(p)) * p;
}

/// The same vector in another type.
template <class To, class From>
KOKKOS_INLINE_FUNCTION constexpr Vector3<To> convert(const Vector3<From>& a) {
  return {static_cast<To>(a.x), static_cast<To>(a.y), static_cast<To>(a.z)};
}

using Vec3 = Vector3<Real>;
using Index3 = Vector3<Index>;

}  // namespace pellicle
