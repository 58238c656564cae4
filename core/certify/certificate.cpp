#include "core/certify/certificate.h"

#include <algorithm>

#include "core/scenario/archive.h"

namespace railcast {

void Describe(Archive& a, CertifiedEcho& s) {
  a.Required("is", s.verdict, "Whether frame and reference have it, or one of them only.");
  a.Required("label", s.label, "The reference's, or the frame's where only that has it.");
  a.Optional("instance", s.instance, "Likewise.");
  a.Required("range_m", s.range_m, "True range.");
  a.Optional("range_error_m", s.range_error_m, "Of the frame before range noise, without a sign.");
  a.Optional("power", s.power, "Received power, that of the frame over the reference's.");
  a.Optional("other_label", s.has_other_label, "Whether the frame gives it another label.");
}

void Describe(Archive& a, VerdictCounts& s) {
  a.Optional("found", s.found, "Echoes that both have.");
  a.Optional("missed", s.missed, "Those that only the reference has.");
  a.Optional("false", s.wrong, "Those that only the rung has.");
}

void Describe(Archive& a, DrawnFiring& s) {
  a.Required("cell", s.cell, "Of the firing: row * columns + column.");
  a.Required("stratum", s.stratum, "Its place in `strata`, from 0.");
  a.Optional("echoes", s.echoes, "Of surfaces, on either side.");
  a.Optional("rungs", s.rungs, "The same firing on the rungs that manifest.json names.");
}

void Describe(Archive& a, StratumCount& s) {
  a.Required("label", s.label, "Of what the beams meet first; 0 = nothing.");
  a.Optional("range_bin", s.range_bin, "By its range: up to 25, 50, 100 and 200 m, and beyond.");
  a.Optional("edge", s.is_edge, "Whether the beams are at an edge.");
  a.Optional("returned", s.has_return, "Whether the frame has a return of them.");
  a.Required("firings", s.firings, "Their number.");
  a.Required("probability", s.probability, "With which each is drawn.");
}

void Describe(Archive& a, FrameCertificate& s) {
  a.Required("strata", s.strata, "The frame's firings, by their own result.");
  a.Required("drawn", s.drawn, "Firings that were made anew.");
  a.Ensure({"drawn"},
           std::ranges::all_of(
               s.drawn, [&](const DrawnFiring& each) { return each.stratum < s.strata.size(); }),
           "must be in strata that the frame has");
}

}  // namespace railcast
