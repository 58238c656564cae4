#include "core/base/error.h"
#include "core/mesh/assimp_reader.h"

namespace railcast {

bool HasAssimp() {
  return false;
}

SceneMesh ReadScene(SceneSource, const std::string& shown) {
  throw InputError(shown +
                   ": this build of railcast has no assimp and reads OBJ, PLY, STL and OFF " +
                   "files only");
}

}  // namespace railcast
