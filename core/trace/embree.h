#pragma once

// Embree 3 or 4, whichever is installed. They differ in how a query gets its arguments: RayQuery
// hides it.
#if __has_include(<embree4/rtcore.h>) && !defined(RAILCAST_EMBREE_3)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <type_traits>

namespace railcast {

/// What Embree 3 and 4 pass on to functions that they call, by different names.
using EmbreeContext = std::remove_pointer_t<decltype(RTCIntersectFunctionNArguments::context)>;

/// Queries within a function that Embree calls have the same filter as the query around them.
struct RayQueryContext : EmbreeContext {
  RTCFilterFunctionN query_filter = nullptr;
};

#if RTC_VERSION_MAJOR >= 4
inline constexpr RTCSceneFlags kFilteredByQuery = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;
#else
inline constexpr RTCSceneFlags kFilteredByQuery = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;
#endif

/// Whether Embree is to follow the rays of a packet through the scene together.
enum class Coherence { kIncoherent, kCoherent };

inline void InitContext(RayQueryContext& context) {
#if RTC_VERSION_MAJOR >= 4
  rtcInitRayQueryContext(&context);
#else
  rtcInitIntersectContext(&context);
#endif
}

/// The arguments of queries for the first hits of rays.
class RayQuery {
 public:
  /// @param context Of InitContext(); what Embree calls back with. It must outlive the query.
  /// @param filter Called at hits of scenes with the flag kFilteredByQuery; may be null.
  RayQuery(RayQueryContext& context, Coherence coherence, RTCFilterFunctionN filter) {
    const bool is_coherent = coherence == Coherence::kCoherent;
#if RTC_VERSION_MAJOR >= 4
    context.query_filter = filter;
    SetArguments(context,
                 is_coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT);
#else
    context_ = &context;
    context.flags =
        is_coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    context.filter = filter;
#endif
  }

  /// A query within another one, of whose context it leaves flags and filter as they are.
  explicit RayQuery(RayQueryContext& context) {
#if RTC_VERSION_MAJOR >= 4
    SetArguments(context, RTC_RAY_QUERY_FLAG_INCOHERENT);
#else
    context_ = &context;
#endif
  }

  void Intersect1(RTCScene scene, RTCRayHit& ray) {
#if RTC_VERSION_MAJOR >= 4
    rtcIntersect1(scene, &ray, &arguments_);
#else
    rtcIntersect1(scene, context_, &ray);
#endif
  }
  void Intersect16(const int* valid, RTCScene scene, RTCRayHit16& packet) {
#if RTC_VERSION_MAJOR >= 4
    rtcIntersect16(valid, scene, &packet, &arguments_);
#else
    rtcIntersect16(valid, scene, context_, &packet);
#endif
  }

 private:
#if RTC_VERSION_MAJOR >= 4
  void SetArguments(RayQueryContext& context, RTCRayQueryFlags flags) {
    rtcInitIntersectArguments(&arguments_);
    arguments_.context = &context;
    arguments_.filter = context.query_filter;
    arguments_.flags =
        context.query_filter == nullptr
            ? flags
            : static_cast<RTCRayQueryFlags>(flags | RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER);
  }

  RTCIntersectArguments arguments_;
#else
  EmbreeContext* context_;
#endif
};

}  // namespace railcast
