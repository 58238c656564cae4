#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>

#include "core/rail/objects/object_surfaces.h"
#include "railcast/scenario.h"
#include "tests/core/scenario/scenario_files.h"

namespace railcast {
namespace {

const std::filesystem::path kSpectraFolder =
    std::filesystem::path(RAILCAST_SHARED_DATA_DIR) / "reflectance_spectra_ucsb";
const std::filesystem::path kConstantsFolder =
    std::filesystem::path(RAILCAST_SHARED_DATA_DIR) / "optical_constants_nk";

std::vector<Material> Library() {
  return ReadScenario(ScenariosDir() / "minimal.json").materials;
}

SurfaceOptics Optics(const std::string& name, int wavelength_nm) {
  const MaterialLibrary library(Library());
  return OpticsAt(library.materials()[library.Index(name)], wavelength_nm);
}

TEST(MaterialLibrary, GivesBackNoMoreThanItGets) {
  for (const Material& material : Library()) {
    for (const int wavelength_nm : {905, 1550}) {
      const SurfaceOptics optics = OpticsAt(material, wavelength_nm);
      EXPECT_LE(optics.diffuse + optics.specular_f0, 1.0F) << material.name;
    }
  }
}

// ---- Measured spectra: ENVI libraries, 216 float32 values from 350 to 2500 nm in steps of 10 nm.

constexpr std::size_t kNumBands = 216;

double ReflectanceAt(const std::vector<float>& spectra,
                     std::size_t spectrum,
                     double wavelength_nm) {
  const double band = (wavelength_nm - 350.0) / 10.0;
  const auto below = static_cast<std::size_t>(band);
  const float* const first = &spectra[spectrum * kNumBands + below];
  return std::lerp(first[0], first[1], band - static_cast<double>(below));
}

struct Source {
  std::string file;
  std::string kind;  // The third level of the classification in the file's table.
};

// The reflectances of all spectra of one kind.
std::vector<double> Measured(const Source& source, double wavelength_nm) {
  const std::string bytes = TextOf(kSpectraFolder / (source.file + ".sli"));
  std::vector<float> spectra(bytes.size() / sizeof(float));
  std::memcpy(spectra.data(), bytes.data(), spectra.size() * sizeof(float));
  std::istringstream table(TextOf(kSpectraFolder / (source.file + ".csv")));
  std::vector<double> reflectances;
  std::string line;
  std::getline(table, line);
  std::size_t num_lines = 0;
  for (; std::getline(table, line); ++num_lines) {
    if (line.find("," + source.kind + ",measured") == std::string::npos) continue;
    reflectances.push_back(ReflectanceAt(spectra, num_lines, wavelength_nm));
  }
  EXPECT_EQ(spectra.size(), num_lines * kNumBands) << source.file;
  EXPECT_FALSE(reflectances.empty()) << source.kind;
  return reflectances;
}

double Quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  const double place = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return std::lerp(values[below], values[above], place - static_cast<double>(below));
}

struct MeasuredMaterial {
  const char* name;
  std::vector<Source> sources;
  bool with_lobe = false;  // Metal: the measured reflectance includes the specular lobe.
};

void PrintTo(const MeasuredMaterial& measured, std::ostream* out) {
  *out << measured.name;
}

class LibraryMaterial : public testing::TestWithParam<MeasuredMaterial> {};

TEST_P(LibraryMaterial, LiesWithinTheMiddleFourFifthsOfWhatWasMeasured) {
  if (!exists(kSpectraFolder)) GTEST_SKIP() << kSpectraFolder << " is not there";
  for (const int wavelength_nm : {905, 1550}) {
    std::vector<double> measured;
    for (const Source& source : GetParam().sources) {
      const std::vector<double> more = Measured(source, wavelength_nm);
      measured.insert(measured.end(), more.begin(), more.end());
    }
    const SurfaceOptics optics = Optics(GetParam().name, wavelength_nm);
    const float reflectance = optics.diffuse + (GetParam().with_lobe ? optics.specular_f0 : 0.0F);
    EXPECT_GE(reflectance, Quantile(measured, 0.1)) << wavelength_nm;
    EXPECT_LE(reflectance, Quantile(measured, 0.9)) << wavelength_nm;
  }
}

const std::string kUrban = "urban-santa-barbara-10nm";
const std::string kBare = "bare-santa-barbara-10nm";
const std::string kPlants = "npv-santa-barbara-10nm";

INSTANTIATE_TEST_SUITE_P(
    Spectra,
    LibraryMaterial,
    testing::Values(
        MeasuredMaterial{"concrete",
                         {{kUrban, "bridge"}, {kUrban, "driveway"}, {kUrban, "sidewalk"}}},
        MeasuredMaterial{"asphalt",
                         {{kUrban, "asphalt"}, {kUrban, "road"}, {kUrban, "parking_lot"}}},
        MeasuredMaterial{"ballast", {{kUrban, "gravel"}, {kBare, "gravel"}}},
        MeasuredMaterial{"soil", {{kBare, "soil"}, {kBare, "dirt"}}},
        MeasuredMaterial{"roof_tile", {{kUrban, "tile"}}},
        MeasuredMaterial{"wood", {{kUrban, "wood_shingle"}, {kPlants, "wood"}}},
        MeasuredMaterial{"bark", {{kPlants, "bark"}}},
        MeasuredMaterial{"galvanised_steel", {{kUrban, "metal"}}, true},
        MeasuredMaterial{"wagon_paint", {{kUrban, "paint"}}},
        MeasuredMaterial{"grey_paint", {{kUrban, "paint"}}}),
    [](const auto& test) { return test.param.name; });

// The luminance of a spectrum in light of equal energy. The eye's photopic sensitivity is taken to
// be a Gaussian about 559 nm, as is usual.
double LuminanceOfSpectrum(const float* spectrum) {
  double sum = 0.0;
  double whole = 0.0;
  for (std::size_t band = 3; band <= 41; ++band) {  // 380 to 760 nm.
    const double wavelength_um = 0.35 + 0.01 * static_cast<double>(band);
    const double sensitivity = std::exp(-285.4 * std::pow(wavelength_um - 0.559, 2));
    sum += sensitivity * static_cast<double>(spectrum[band]);
    whole += sensitivity;
  }
  return sum / whole;
}

// What PaintOfLuminance() promises of its law, for roofs, roads, walls and paint.
TEST(PaintsOfColours, AreNearerToMeasuredSurfacesThanGreyPaint) {
  if (!exists(kSpectraFolder)) GTEST_SKIP() << kSpectraFolder << " is not there";
  const MaterialLibrary library(Library());
  const std::string bytes = TextOf(kSpectraFolder / (kUrban + ".sli"));
  std::vector<float> spectra(bytes.size() / sizeof(float));
  std::memcpy(spectra.data(), bytes.data(), spectra.size() * sizeof(float));
  std::vector<double> ratios;
  double of_paints = 0.0;
  double of_grey = 0.0;
  for (std::size_t i = 0; i < spectra.size() / kNumBands; ++i) {
    const double reflectance = ReflectanceAt(spectra, i, 905.0);
    const double luminance = LuminanceOfSpectrum(&spectra[i * kNumBands]);
    ratios.push_back(reflectance / luminance);
    const auto paint = PaintOfLuminance(library, luminance);
    ASSERT_TRUE(paint.has_value());
    const auto error_of = [&](std::size_t material) {
      return std::pow(std::log(reflectance / library.materials()[material].reflectivity), 2);
    };
    of_paints += error_of(*paint);
    of_grey += error_of(library.Index("grey_paint"));
  }
  const auto num = static_cast<double>(ratios.size());
  EXPECT_EQ(num, 888.0);
  EXPECT_NEAR(Quantile(ratios, 0.05), 0.97, 0.01);
  EXPECT_NEAR(Quantile(ratios, 0.5), 1.20, 0.01);
  EXPECT_NEAR(Quantile(ratios, 0.95), 2.22, 0.01);
  EXPECT_NEAR(std::exp(std::sqrt(of_paints / num)), 1.43, 0.02);
  EXPECT_NEAR(std::exp(std::sqrt(of_grey / num)), 2.42, 0.02);
}

// ---- Optical constants: lines of wavelength in micrometres, n, k; or a formula for n.

// Fresnel reflectance at normal incidence.
double Fresnel(double n, double k) {
  return ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k);
}

double FresnelOfTable(const std::string& file, double wavelength_nm) {
  std::istringstream lines(TextOf(kConstantsFolder / file));
  std::optional<std::array<double, 3>> before;
  std::string line;
  while (std::getline(lines, line)) {
    std::array<double, 3> row{};
    std::istringstream numbers(line);
    if (!(numbers >> row[0] >> row[1] >> row[2])) continue;
    row[0] *= 1000.0;
    if (row[0] >= wavelength_nm && before) {
      const double share = (wavelength_nm - (*before)[0]) / (row[0] - (*before)[0]);
      return Fresnel(std::lerp((*before)[1], row[1], share),
                     std::lerp((*before)[2], row[2], share));
    }
    before = row;
  }
  ADD_FAILURE() << file << " has nothing at " << wavelength_nm << " nm";
  return 0.0;
}

// Formula 5 of the database: n = c0 + c1 L^c2 + c3 L^c4, L in micrometres. Absorption in glass is
// neglected.
double FresnelOfFormula(const std::string& file, double wavelength_nm) {
  const std::string text = TextOf(kConstantsFolder / file);
  const std::string key = "coefficients:";
  const std::size_t place = text.find(key);
  EXPECT_NE(text.find("type: formula 5"), std::string::npos) << file;
  EXPECT_NE(place, std::string::npos) << file;
  std::istringstream numbers(text.substr(place + key.size()));
  std::array<double, 5> c{};
  for (double& coefficient : c) EXPECT_TRUE(numbers >> coefficient) << file;
  const double wavelength_um = wavelength_nm / 1000.0;
  return Fresnel(c[0] + c[1] * std::pow(wavelength_um, c[2]) + c[3] * std::pow(wavelength_um, c[4]),
                 0.0);
}

TEST(MaterialLibrary, HasTheLobeOfIronOnTheRailHead) {
  if (!exists(kConstantsFolder)) GTEST_SKIP() << kConstantsFolder << " is not there";
  for (const int wavelength_nm : {905, 1550}) {
    std::vector<double> iron;
    for (const char* author : {"Johnson", "Ordal", "Querry"}) {
      iron.push_back(FresnelOfTable(std::string("main_Fe_nk_") + author + ".yml", wavelength_nm));
    }
    const float f0 = Optics("rail_head", wavelength_nm).specular_f0;
    EXPECT_GE(f0, *std::min_element(iron.begin(), iron.end()));
    EXPECT_LE(f0, *std::max_element(iron.begin(), iron.end()));
  }
}

TEST(MaterialLibrary, HasTheLobesOfTwoFacesOfGlassAndOfAFilmOfWater) {
  if (!exists(kConstantsFolder)) GTEST_SKIP() << kConstantsFolder << " is not there";
  constexpr double kRounding = 0.005;  // The library gives two decimals.
  for (const int wavelength_nm : {905, 1550}) {
    const double face =
        FresnelOfFormula("glass_misc_soda-lime_nk_Rubin-lowiron.yml", wavelength_nm);
    EXPECT_NEAR(Optics("glass", wavelength_nm).specular_f0, 2.0 * face, kRounding);
    EXPECT_NEAR(Optics("wagon_paint", wavelength_nm).specular_f0, face, kRounding);
    const double film = FresnelOfTable("main_H2O_nk_Hale.yml", wavelength_nm);
    EXPECT_NEAR(WetOptics({.diffuse = 0.5F}, 1.0, wavelength_nm).specular_f0, film, kRounding);
  }
}

}  // namespace
}  // namespace railcast
