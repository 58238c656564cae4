#pragma once

#include <cstddef>
#include <memory>

#include "railcast/scene.h"

namespace railcast {

/// The rigid pieces of any object: those of an object that bends, otherwise its model alone.

[[nodiscard]] inline std::size_t NumPieces(const SceneObject& object) {
  return object.pieces.empty() ? 1 : object.pieces.size();
}

/// @pre piece < NumPieces(object).
[[nodiscard]] inline const std::shared_ptr<const Model>& PieceOf(const SceneObject& object,
                                                                 std::size_t piece) {
  return object.pieces.empty() ? object.model : object.pieces[piece];
}

}  // namespace railcast
