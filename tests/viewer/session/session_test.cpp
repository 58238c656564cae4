#include "viewer/session/session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/analysis/recorded_frames.h"
#include "tests/core/io/example_frame.h"
#include "tests/core/io/message_of.h"
#include "tests/viewer/session/held_frames.h"
#include "viewer/frames/shown_frame.h"

namespace railcast {
namespace {

using testing::SizeIs;

Choices By(const std::string& field) {
  return {.color_by = field};
}

TEST(Session, ShowsNothingAtFirst) {
  HeldFrames frames({Share(NumberedCloud(0))});
  Session session({&frames}, {});
  EXPECT_FALSE(session.has_frame());
  EXPECT_THAT(session.Compose(), SizeIs(1));
  EXPECT_TRUE(session.Compose()[0].clouds.empty());
  EXPECT_EQ(session.Compose()[0].status, "");
  EXPECT_EQ(session.Period_s(), 0.1);
}

TEST(Session, ShowsTheFrameThatIsSought) {
  HeldFrames frames({Share(NumberedCloud(4)), Share(NumberedCloud(5))});
  Session session({&frames}, {});
  ASSERT_TRUE(session.Seek(1));
  EXPECT_TRUE(session.has_frame());
  EXPECT_EQ(session.place(), 1U);
  EXPECT_EQ(session.shown(0), frames.Get(1));
  EXPECT_EQ(session.LastPlace(), 1U);
  EXPECT_EQ(session.choices().color_by, "height");
  EXPECT_EQ(session.Compose()[0].clouds.at(0).shown, frames.Get(1));
  EXPECT_EQ(session.Compose()[0].status, "held   frame 5   1.000 s   2 points");
}

TEST(Session, KeepsItsFrameWhereThereIsNoneToSeek) {
  HeldFrames frames({Share(NumberedCloud(0)), Share(NumberedCloud(1))});
  Session session({&frames}, {});
  EXPECT_FALSE(session.Seek(2));
  EXPECT_FALSE(session.has_frame());
  ASSERT_TRUE(session.Seek(1));
  EXPECT_FALSE(session.Seek(2));
  EXPECT_EQ(session.place(), 1U);
  EXPECT_EQ(session.shown(0), frames.Get(1));
}

TEST(Session, KeepsItsFrameWhereTheNextIsDamaged) {
  HeldFrames frames({Share(NumberedCloud(0)), nullptr});
  Session session({&frames}, {});
  ASSERT_TRUE(session.Seek(0));
  EXPECT_EQ(MessageOf([&] { (void)session.Seek(1); }), "held: is damaged");
  EXPECT_EQ(session.place(), 0U);
  EXPECT_EQ(session.shown(0), frames.Get(0));
}

TEST(Session, RefusesAFirstFrameThatCannotBeColouredAsChosen) {
  HeldFrames frames({Share(NumberedCloud(0))});
  Session session({&frames}, By("power"));
  EXPECT_EQ(MessageOf([&] { (void)session.Seek(0); }),
            "0.pcd: has no field power to color by (has: range, height, x, y)");
  EXPECT_FALSE(session.has_frame());
}

TEST(Session, HasNoPlaceBeyondTheFirstWhereNoFrameIsKnown) {
  HeldFrames none({});
  const Session session({&none}, {});
  EXPECT_EQ(session.LastPlace(), 0U);
}

TEST(Session, ColoursByAllFieldsInTurnAndRound) {
  RecordedFrame recorded = Record(ExampleFrame(3));
  recorded.foreign = {{"curvature", std::vector<float>(recorded.frame.num_slots(), 1.0F)}};
  HeldFrames frames({std::make_shared<const ShownFrame>(MakeShownFrame(std::move(recorded)))});
  Session session({&frames}, {});
  ASSERT_TRUE(session.Seek(0));
  const std::vector<std::string> fields = ColorableFields(*session.shown(0)->recorded);
  ASSERT_EQ(fields.back(), "curvature");
  ASSERT_EQ(session.choices().color_by, fields.front());
  for (std::size_t i = 1; i <= fields.size(); ++i) {
    session.ColorByNext(true);
    EXPECT_EQ(session.choices().color_by, fields[i % fields.size()]);
    const bool is_kind =
        ValuesOf(*session.shown(0), fields[i % fields.size()]).kind == FieldValues::Kind::kCategory;
    EXPECT_EQ(session.choices().ends.has_value(), !is_kind) << session.choices().color_by;
    EXPECT_THAT(session.Compose()[0].clouds[0].colors, SizeIs(session.shown(0)->num_points()));
  }
  for (std::size_t i = fields.size(); i-- > 0;) {
    session.ColorByNext(false);
    EXPECT_EQ(session.choices().color_by, fields[i]);
  }
}

TEST(Session, FitsTheScaleOfEveryFieldItTurnsTo) {
  HeldFrames frames({Share(NumberedCloud(0))});
  Session session({&frames}, {});
  ASSERT_TRUE(session.Seek(0));
  EXPECT_EQ(session.choices().ends, (std::array{1.0, 2.0})) << "height";
  session.ColorByNext(true);
  EXPECT_EQ(session.choices().color_by, "x");
  EXPECT_EQ(session.choices().ends, (std::array{-0.5, 0.5}));
}

TEST(Session, KeepsTheScaleUntilItIsFittedAnew) {
  HeldFrames frames({Share(NumberedCloud(0)), Share(NumberedCloud(7))});
  Session session({&frames}, By("height"));
  ASSERT_TRUE(session.Seek(0));
  ASSERT_TRUE(session.Seek(1));
  EXPECT_EQ(session.Compose()[0].coloring.ends, (std::array{1.0, 2.0}));
  session.FitScale();
  EXPECT_EQ(session.Compose()[0].coloring.ends, (std::array{1.0, 9.0}));
}

TEST(Session, SaysThatAFrameLacksTheFieldAndShowsAnother) {
  HeldFrames frames({Share(LabelledCloud(0)), Share(NumberedCloud(1)), Share(LabelledCloud(2))});
  Session session({&frames}, {});
  ASSERT_TRUE(session.Seek(0));
  ASSERT_TRUE(session.Seek(1));
  const Composition composition = session.Compose()[0];
  EXPECT_EQ(composition.status,
            "held   frame 1   0.200 s   2 points\nhas no field label to color by");
  EXPECT_EQ(composition.coloring.title, "height [m]");
  EXPECT_EQ(composition.coloring.ends, (std::array{1.0, 3.0}));
  session.FitScale();
  ASSERT_TRUE(session.Seek(2));
  EXPECT_EQ(session.Compose()[0].coloring.title, "label") << "the choice stays";
}

TEST(Session, FitsAScaleOfItsOwnToTheFieldShownInstead) {
  RecordedFrame bright = NumberedCloud(0);
  bright.fields.emplace("intensity");
  bright.frame.intensity = {0.25F, 0.75F};
  HeldFrames frames({Share(bright), Share(NumberedCloud(1))});
  Session session({&frames}, By("intensity"));
  ASSERT_TRUE(session.Seek(0));
  ASSERT_TRUE(session.Seek(1));
  EXPECT_EQ(session.Compose()[0].coloring.ends, (std::array{1.0, 3.0})) << "of heights";
  EXPECT_EQ(session.choices().ends, (std::array{0.25, 0.75})) << "kept for when it is back";
}

TEST(Session, ShowsFramesWithoutLabelsWhileSomeAreSelected) {
  HeldFrames frames({Share(LabelledCloud(0)), Share(NumberedCloud(1))});
  frames.UseLabels(ExampleLabels());
  Session session({&frames}, {});
  ASSERT_TRUE(session.Seek(0));
  session.ToggleLabel(12);
  EXPECT_EQ(session.Compose()[0].status, "held   frame 0   2 points\nselected wagon: 1 points");
  ASSERT_TRUE(session.Seek(1));
  const Composition composition = session.Compose()[0];
  EXPECT_EQ(composition.status,
            "held   frame 1   0.200 s   2 points\nselected wagon: 0 points\n"
            "has no field label to color by");
  EXPECT_EQ(composition.coloring.title, "height [m]");
  session.ColorByNext(true);
  EXPECT_EQ(session.choices().color_by, "x") << "after the height that was shown";
}

TEST(Session, TurnsFromTheFieldThatIsShownInstead) {
  HeldFrames frames({Share(LabelledCloud(0)), Share(NumberedCloud(1))});
  for (const bool forward : {true, false}) {
    Session session({&frames}, {});
    ASSERT_TRUE(session.Seek(0));
    ASSERT_TRUE(session.Seek(1));
    session.ColorByNext(forward);
    // The fields are range, height, x and y, and height was current.
    EXPECT_EQ(session.choices().color_by, forward ? "x" : "range");
  }
}

TEST(Session, SelectsALabelUntilItIsToggledAgain) {
  HeldFrames frames({Share(LabelledCloud(0))});
  Session session({&frames}, {});
  ASSERT_TRUE(session.Seek(0));
  session.ToggleLabel(12);
  session.ToggleLabel(1);
  EXPECT_EQ(session.choices().labels, (std::set<std::uint32_t>{1, 12}));
  session.ToggleLabel(12);
  EXPECT_EQ(session.choices().labels, (std::set<std::uint32_t>{1}));
}

TEST(Session, AccumulatesAsManyFramesAsThereAre) {
  std::vector<std::shared_ptr<const ShownFrame>> held;
  for (std::uint32_t i = 0; i < 5; ++i) held.push_back(Share(MovingCloud(i)));
  HeldFrames frames(held);
  Choices choices{.num_accumulated = 3};
  Session session({&frames}, choices);
  ASSERT_TRUE(session.Seek(1));
  EXPECT_THAT(session.Compose()[0].clouds, SizeIs(2));
  ASSERT_TRUE(session.Seek(4));
  const Composition composition = session.Compose()[0];
  ASSERT_THAT(composition.clouds, SizeIs(3));
  for (std::size_t back = 0; back < 3; ++back) {
    EXPECT_EQ(composition.clouds[back].shown, held[4 - back]);
    EXPECT_EQ(composition.clouds[back].view_from_sensor.translation().x(),
              -2.0 * static_cast<double>(back));
  }
  EXPECT_EQ(session.Missing(), "");
}

TEST(Session, SaysThatFramesWithoutPosesAreNotAccumulated) {
  HeldFrames frames({Share(NumberedCloud(0)), Share(NumberedCloud(1))});
  Choices choices{.num_accumulated = 2};
  Session session({&frames}, choices);
  ASSERT_TRUE(session.Seek(1));
  EXPECT_EQ(session.Missing(), "frames without poses are not accumulated");
  EXPECT_EQ(session.Compose()[0].status,
            "held   frame 1   0.200 s   2 points\nframes without poses are not accumulated");
}

TEST(Session, SaysWhichOverlaysAreMissing) {
  HeldFrames frames({Share(MovingCloud(0))});
  Choices choices;
  choices.overlays.track = true;
  Session session({&frames}, choices);
  ASSERT_TRUE(session.Seek(0));
  EXPECT_EQ(session.Missing(), "no track is found: no ground is seen");
}

TEST(Session, KnowsTheTimeFromFrameToFrame) {
  RecordedFrame same_time = NumberedCloud(2);
  same_time.frame.stamp_ns = 200'000'000;
  HeldFrames frames({Share(NumberedCloud(0)), Share(NumberedCloud(1)), Share(same_time)});
  Session session({&frames}, {});
  ASSERT_TRUE(session.Seek(0));
  EXPECT_DOUBLE_EQ(session.Period_s(), 0.2) << "to the next";
  ASSERT_TRUE(session.Seek(1));
  EXPECT_DOUBLE_EQ(session.Period_s(), 0.2) << "since the one before";
  ASSERT_TRUE(session.Seek(2));
  EXPECT_EQ(session.Period_s(), 0.1) << "as usual, of equal stamps";
  HeldFrames single({Share(NumberedCloud(0))});
  Session of_one({&single}, {});
  ASSERT_TRUE(of_one.Seek(0));
  EXPECT_EQ(of_one.Period_s(), 0.1);
}

TEST(Session, OfTwoSourcesShowsTheSamePlaceOfBothSideBySide) {
  HeldFrames a({Share(NumberedCloud(0)), Share(NumberedCloud(1)), Share(NumberedCloud(2))}, "a");
  HeldFrames b({Share(NumberedCloud(5)), Share(NumberedCloud(6))}, "b");
  Session session({&a, &b}, {});
  EXPECT_EQ(session.num_sources(), 2U);
  EXPECT_EQ(session.num_views(), 2U);
  EXPECT_EQ(session.LastPlace(), 1U);
  ASSERT_TRUE(session.Seek(1));
  EXPECT_FALSE(session.Seek(2)) << "only one has it";
  const auto compositions = session.Compose();
  ASSERT_THAT(compositions, SizeIs(2));
  EXPECT_EQ(compositions[0].status, "a   frame 1   0.200 s   2 points");
  EXPECT_EQ(compositions[1].status, "b   frame 6   1.200 s   2 points");
  EXPECT_EQ(compositions[1].coloring.ends, compositions[0].coloring.ends) << "one scale for both";
}

// Something was put into frames 1 and 2 of a capture.
TEST(Session, OfACaptureAndSomeOfItsFramesShowsThoseOfTheSameNumber) {
  HeldFrames a({Share(NumberedCloud(0)), Share(NumberedCloud(1)), Share(NumberedCloud(2))}, "a");
  HeldFrames b({Share(NumberedCloud(1)), Share(NumberedCloud(2))}, "b");
  for (HeldFrames* const frames : {&a, &b}) frames->UseKind("capture of VLP-16");
  Session session({&a, &b}, {});
  EXPECT_EQ(session.FirstPlace(), 1U);
  EXPECT_EQ(session.LastPlace(), 2U);
  ASSERT_TRUE(session.Seek(2));
  EXPECT_EQ(session.Compose()[1].status, "b   frame 2   0.400 s   2 points");
  EXPECT_FALSE(session.Seek(0));
}

TEST(Session, ColoursTwoSourcesByWhatBothHave) {
  HeldFrames a({Share(LabelledCloud(0))}, "a");
  HeldFrames b({Share(NumberedCloud(5))}, "b");
  Session session({&a, &b}, {});
  ASSERT_TRUE(session.Seek(0));
  EXPECT_EQ(session.choices().color_by, "height");
}

TEST(Session, ColoursTheSourceThatHasTheFieldAskedForAndSaysThatTheOtherLacksIt) {
  HeldFrames a({Share(NumberedCloud(5))}, "a");
  HeldFrames b({Share(LabelledCloud(0))}, "b");
  for (const std::size_t labelled : {0U, 1U}) {
    Session session(labelled == 0 ? std::vector<Frames*>{&b, &a} : std::vector<Frames*>{&a, &b},
                    By("label"));
    ASSERT_TRUE(session.Seek(0));
    const auto compositions = session.Compose();
    EXPECT_EQ(compositions[labelled].coloring.title, "label");
    EXPECT_EQ(compositions[1 - labelled].coloring.title, "height [m]");
    EXPECT_THAT(compositions[1 - labelled].status,
                testing::EndsWith("\nhas no field label to color by"));
  }
}

TEST(Session, RefusesTwoSourcesThatBothLackTheFieldAskedFor) {
  HeldFrames a({Share(NumberedCloud(0))}, "a");
  HeldFrames b({Share(NumberedCloud(5))}, "b");
  Session session({&a, &b}, By("label"));
  EXPECT_EQ(MessageOf([&] { (void)session.Seek(0); }),
            "0.pcd: has no field label to color by (has: range, height, x, y)");
}

TEST(Session, OfTwoSourcesShowsTheirDistancesInOneView) {
  HeldFrames a({Share(NumberedCloud(0))}, "a");
  HeldFrames b({Share(NumberedCloud(3))}, "b");
  Choices choices{.layout = Layout::kDistance};
  Session session({&a, &b}, choices);
  EXPECT_EQ(session.num_views(), 1U);
  ASSERT_TRUE(session.Seek(0));
  const auto compositions = session.Compose();
  ASSERT_THAT(compositions, SizeIs(1));
  EXPECT_THAT(compositions[0].clouds, SizeIs(2));
  EXPECT_EQ(compositions[0].coloring.title, "to the other's nearest point [m]");
  EXPECT_EQ(compositions[0].status, "a   frame 0   2 points\nb   frame 3   0.600 s   2 points");
  EXPECT_EQ(session.choices().distance_ends_m, compositions[0].coloring.ends)
      << "kept for later frames";
  session.FitScale();
  EXPECT_EQ(session.choices().distance_ends_m, std::nullopt) << "to be fitted to the next";
}

TEST(Session, OfTwoSourcesShowsTheChangesInTheAxesOfTheSecond) {
  HeldFrames a({Share(MovingCloud(0))}, "a");
  HeldFrames b({Share(MovingCloud(3))}, "b");
  Choices choices{.layout = Layout::kChanges};
  Session session({&a, &b}, choices);
  EXPECT_EQ(session.num_views(), 1U);
  ASSERT_TRUE(session.Seek(0));
  const auto compositions = session.Compose();
  ASSERT_THAT(compositions, SizeIs(1));
  ASSERT_THAT(compositions[0].clouds, SizeIs(2));
  EXPECT_EQ(compositions[0].clouds[0].shown, session.shown(1));
  EXPECT_EQ(compositions[0].coloring.title, "change");
  EXPECT_EQ(compositions[0].status,
            "a   frame 0   0.000 s   2 points\nb   frame 3   0.600 s   2 points");
}

}  // namespace
}  // namespace railcast
