#include "generator/live/live_clock.h"
#include "generator/live/live_streams.h"
#include "generator/run/make_frames.h"

namespace railcast {

LiveCertificate::LiveCertificate(FrameMaker& maker,
                                 std::size_t sensor,
                                 const ScenarioSpec& scenario,
                                 double cost_share)
    : maker_(maker),
      sensor_(sensor),
      certifier_(scenario, cost_share, maker.simulator(sensor)),
      spec_(CertifySpecOf(scenario, maker.simulator(sensor).world(), certifier_, cost_share)),
      sums_(spec_) {}

void LiveCertificate::Try(const Frame& frame) {
  const MonotonicClock clock;
  // The first time takes longer: tables and memory are made.
  for (int i = 0; i < 2; ++i) {
    const std::int64_t begin_ns = clock.NowNs();
    CertificateSums sums(spec_);
    sums.Add(Certify(frame));
    tried_ns_ = clock.NowNs() - begin_ns;
  }
}

void LiveCertificate::Add(const Frame& frame) {
  if (num_drawn_ >= kMostDrawn) return;
  const FrameCertificate certificate = Certify(frame);
  num_drawn_ += certificate.drawn.size();
  sums_.Add(certificate);
}

void LiveCertificate::Restart() {
  sums_ = CertificateSums(spec_);
  num_drawn_ = 0;
}

FrameCertificate LiveCertificate::Certify(const Frame& frame) {
  Simulator& simulator = maker_.At(sensor_, frame.index);
  const auto begun = simulator.Begin(frame.index);
  return certifier_.Certify(simulator, *begun, frame);
}

}  // namespace railcast
