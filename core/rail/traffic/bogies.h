#pragma once

#include "core/rail/motion/track_path.h"
#include "core/rail/objects/object_models.h"
#include "railcast/alignment.h"
#include "railcast/objects.h"
#include "railcast/scene.h"

namespace railcast {

/// Whether an object rests on the track with two pivots: a rail vehicle that does not lean.
[[nodiscard]] bool RestsOnPivots(const ObjectSpec& object);

/// Gives a rail vehicle its pieces, body, front bogie and rear bogie, if the bogies turn against
/// the body: if it moves or stands where the track is bent. A vehicle that stands turned against
/// its track has left it, and is rigid.
void GiveBogies(const ObjectSpec& spec,
                const TrackPath& path,
                const Alignment& alignment,
                ObjectModels& models,
                SceneObject& object);

}  // namespace railcast
