// A family of models whose members are the alternatives of a std::variant, each a struct with a static `info`.
#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <variant>

#include "core/model_list.hpp"

namespace pellicle::core {

namespace detail {
template <class Variant, std::size_t... I>
constexpr auto infos_of(std::index_sequence<I...>) {
  return std::array<ModelInfo, sizeof...(I)>{std::variant_alternative_t<I, Variant>::info...};
}
template <class Variant>
inline constexpr auto infos = infos_of<Variant>(std::make_index_sequence<std::variant_size_v<Variant>>{});

template <class Variant, std::size_t... I>
Variant make_alternative(std::size_t index, std::index_sequence<I...>) {
  Variant made;
  (void)((I == index ? (made.template emplace<I>(), true) : false) || ...);
  return made;
}
}  // namespace detail

/// The infos of a family's members, in the order of the variant's alternatives.
template <class Variant>
constexpr ModelList model_list() {
  return detail::infos<Variant>;
}

/// The member at a position of model_list (see find_model); the first one if the position is out of range.
template <class Variant>
Variant make_model(int index) {
  return detail::make_alternative<Variant>(static_cast<std::size_t>(index),
                                           std::make_index_sequence<std::variant_size_v<Variant>>{});
}

/// The info of the member that a variant holds.
template <class Variant>
constexpr const ModelInfo& model_info(const Variant& model) {
  return detail::infos<Variant>[model.index()];
}

}  // namespace pellicle::core
