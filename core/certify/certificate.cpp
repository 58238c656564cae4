#include "core/certify/certificate.h"

#include <algorithm>

#include "core/scenario/archive.h"

namespace railcast {

void Describe(Archive& a, CertifiedEcho& s) {
  a.Required("is", s.verdict, "Whether frame and reference have it, or one of them only.");
  a.Required("label", s.label, "Its label in the reference, or in the frame if only that has it.");
  a.Optional("instance", s.instance,
             "Its instance in the reference, or in the frame if only that has it.");
  a.Required("range_m", s.range_m, "Its true range.");
  a.Optional("range_error_m", s.range_error_m,
             "Error of the frame's range before noise, without a sign.");
  a.Optional("power", s.power, "Received power in the frame, divided by that in the reference.");
  a.Optional("other_label", s.has_other_label, "Whether the frame gives it another label.");
}

void Describe(Archive& a, VerdictCounts& s) {
  a.Optional("found", s.found, "Echoes that both have.");
  a.Optional("missed", s.missed, "Echoes that only the reference has.");
  a.Optional("false", s.wrong, "Echoes that only the rung has.");
}

void Describe(Archive& a, DrawnFiring& s) {
  a.Required("cell", s.cell, "Number of the firing: row * columns + column.");
  a.Required("stratum", s.stratum, "Index of its stratum in `strata`, from 0.");
  a.Optional("echoes", s.echoes, "Echoes of surfaces that the frame or the reference has.");
  a.Optional("rungs", s.rungs, "The same firing on the rungs that manifest.json names.");
}

void Describe(Archive& a, StratumCount& s) {
  a.Required("label", s.label, "Label of what the beams meet first; 0 = nothing.");
  a.Optional("range_bin", s.range_bin,
             "Bin of its range: up to 25, 50, 100 and 200 m, and beyond.");
  a.Optional("edge", s.is_edge, "Whether the beams are at an edge.");
  a.Optional("returned", s.has_return, "Whether the frame has a return of them.");
  a.Required("firings", s.firings, "Number of firings in the stratum.");
  a.Required("probability", s.probability, "Probability with which each of them is drawn.");
}

void Describe(Archive& a, FrameCertificate& s) {
  a.Required("strata", s.strata, "The frame's firings in strata, by their own results.");
  a.Required("drawn", s.drawn, "Firings that were made anew.");
  a.Ensure({"drawn"},
           std::ranges::all_of(
               s.drawn, [&](const DrawnFiring& each) { return each.stratum < s.strata.size(); }),
           "must be in strata that the frame has");
}

}  // namespace railcast
