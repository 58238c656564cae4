#include "analysis/report/cell_text.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/analysis/report/made_report.h"

namespace railcast {
namespace {

std::string Line(const Cell& cell) {
  return LineOf(TextOf(cell));
}

TEST(CellText, EndsAnEstimateAtTheSecondDigitOfItsInterval) {
  EXPECT_EQ(Line(Estimate{12.3412, 11.9, 12.7811, 4512}), "12.34 [11.90, 12.78], n = 4,512");
  EXPECT_EQ(Line(Estimate{0.012345, 0.01234, 0.01235, 10}),
            "0.0123450 [0.0123400, 0.0123500], n = 10");
  EXPECT_EQ(Line(Estimate{123456.0, 121000.0, 126000.0, 10}), "123,500 [121,000, 126,000], n = 10");
  EXPECT_EQ(Line(Estimate{-2.98, -3.9, -2.1, 10}), "-2.98 [-3.90, -2.10], n = 10");
}

TEST(CellText, ShowsNoMoreThanSevenDigitsHoweverNarrowTheInterval) {
  EXPECT_EQ(Line(Estimate{1.0, 1.0 - 1e-12, 1.0 + 1e-12, 10}),
            "1.000000 [1.000000, 1.000000], n = 10");
}

TEST(CellText, TakesPowersOfTenForTinyAndHugeNumbers) {
  EXPECT_EQ(Line(Estimate{3.0663e-5, 2.7741e-5, 3.3585e-5, 12}),
            "3.07e-05 [2.77e-05, 3.36e-05], n = 12");
  EXPECT_EQ(Line(2.5e12), "2.500e+12");
}

TEST(CellText, CallsTooFewSamplesNotEnough) {
  EXPECT_EQ(Line(NotEnough(3)), "not enough (n = 3)");
  EXPECT_TRUE(TextOf(NotEnough(0)).is_absent);
}

TEST(CellText, LeavesOutAnIntervalThatIsNotKnown) {
  EXPECT_EQ(Line(Estimate{0.5, kNoFigure, kNoFigure, 20}), "0.5, n = 20");
  EXPECT_EQ(Line(Estimate{0.5, 0.2, std::numeric_limits<double>::infinity(), 20}), "0.5, n = 20");
}

TEST(CellText, ShowsAnIntervalWithoutWidth) {
  EXPECT_EQ(Line(Estimate{2.5, 2.5, 2.5, 20}), "2.5 [2.5, 2.5], n = 20");
}

TEST(CellText, WritesNumbersForPeople) {
  EXPECT_EQ(Line(std::uint64_t{1234567}), "1,234,567");
  EXPECT_EQ(Line(std::uint64_t{0}), "0");
  EXPECT_EQ(Line(119.94321), "119.9");
  EXPECT_EQ(Line(0.5), "0.5");
  EXPECT_EQ(Line(-1234.5), "-1,234");
  EXPECT_EQ(Line(123456.0), "123,456");
  EXPECT_EQ(Line(1.5e-7), "1.500e-07");
  EXPECT_EQ(Line(0.0), "0");
  EXPECT_EQ(Line(-0.0), "0");
}

TEST(CellText, NeverWritesNanAsANumber) {
  EXPECT_EQ(Line(kNoFigure), "-");
  EXPECT_TRUE(TextOf(kNoFigure).is_absent);
  EXPECT_EQ(Line(Estimate{kNoFigure, 1.0, 2.0, 50}), "not enough (n = 50)");
}

}  // namespace
}  // namespace railcast
