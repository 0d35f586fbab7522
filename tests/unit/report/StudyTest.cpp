// Studies of subjects that are no renderers: their errors, times and faults are known.
#include "report/Study.h"
#include "report/Page.h"
#include "report/Summary.h"
#include "report/measures/RunningVariance.h"

#include "support/AtomicFile.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <random>
#include <set>

using namespace rtsl;
using namespace rtsl::report;
using runtime::Image;
namespace fs = std::filesystem;

namespace {

constexpr std::uint32_t width = 24, height = 16;
constexpr double secondsPerSample = 1e-3;

Image truth() {
  Image image(width, height, 3);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = 0.5f + 0.4f * std::sin(float(i));
  return image;
}

/// Noise of a known size about the truth, and a time that is proportional to the samples.
Subject noisy(const std::string &name, double noise, double slowness = 1,
              unsigned *calls = nullptr) {
  Subject subject;
  subject.name = name;
  subject.settings = {{"noise", std::to_string(noise)}};
  subject.render = [=](std::uint32_t samples, std::uint32_t seed) {
    if (calls)
      ++*calls;
    std::mt19937 random(seed);
    std::normal_distribution<float> normal(0, 1);
    Picture picture;
    picture.image = truth();
    for (float &value : picture.image.pixels)
      value += float(noise / std::sqrt(double(samples))) * normal(random);
    picture.statistics.renderSeconds = secondsPerSample * samples * slowness;
    picture.statistics.buildSeconds = 0.002;
    return picture;
  };
  return subject;
}

class Studies : public testing::Test {
protected:
  void SetUp() override {
    folder = fs::temp_directory_path() /
             ("rtsl-study-" +
              std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder);
    fs::create_directories(folder);
    reference.image = truth();
    reference.origin = "known";
    options.folder = folder.string();
    options.budgetSeconds = 1;
  }
  void TearDown() override { fs::remove_all(folder); }

  Summary study(const std::vector<Subject> &subjects) {
    return summarise(subjects, runStudy(subjects, reference, options), reference);
  }
  std::string problems(const Summary &summary) {
    std::string all;
    for (const std::string &problem : summary.problems)
      all += problem + "\n";
    return all;
  }

  fs::path folder;
  Reference reference;
  StudyOptions options;
};

} // namespace

TEST_F(Studies, FindTheSlopeOfIndependentSamples) {
  const Summary summary = study({noisy("strict", 0.2)});
  const SubjectSummary &subject = summary.subjects.front();
  EXPECT_NEAR(subject.relMseOverSamples.slope.value, -1, 0.02);
  EXPECT_LE(subject.relMseOverSamples.slope.low, -1);
  EXPECT_GE(subject.relMseOverSamples.slope.high, -1);
  EXPECT_NEAR(subject.relMseOverSeconds.slope.value, -1, 0.02);
  EXPECT_EQ(problems(summary), "");
}

TEST_F(Studies, FindEfficiencyAndTheCostOfASlowerWay) {
  const Summary summary = study({noisy("fast", 0.2), noisy("slow", 0.2, 3)});
  ASSERT_EQ(summary.subjects.size(), 2u);
  // 1 / (0.2^2 / n x n x 1 ms)
  EXPECT_NEAR(summary.subjects[0].efficiency / (1 / (0.04 * secondsPerSample)), 1, 0.05);
  ASSERT_TRUE(summary.subjects[1].toCommonRelMse && summary.subjects[1].timesTheQuickest);
  EXPECT_NEAR(summary.subjects[1].timesTheQuickest->value, 3, 1e-6)
      << "the errors are the same, so the times tell";
  EXPECT_NEAR(summary.subjects[1].toCommonRelMse->seconds.value /
                  summary.subjects[0].toCommonRelMse->seconds.value,
              3, 1e-6);
  for (const LevelSummary &level : summary.subjects[1].levels) {
    ASSERT_TRUE(level.timesTheFirst) << level.samplesPerPixel;
    EXPECT_NEAR(level.timesTheFirst->value, 3, 1e-6);
  }
  EXPECT_FALSE(summary.subjects[0].levels.front().timesTheFirst);
  // The same seeds gave the same pictures.
  EXPECT_EQ(summary.subjects[0].commonPicture, summary.subjects[1].commonPicture);
}

TEST_F(Studies, KeepToTheBudget) {
  // 8 runs x (1 + 2 + 4 + 8) ms is 0.12 s, and 16 more would be 0.248 s
  options.budgetSeconds = 0.2;
  const Summary summary = study({noisy("strict", 0.2), noisy("slow", 0.2, 100)});
  EXPECT_EQ(summary.subjects[0].levels.back().samplesPerPixel, 8u);
  EXPECT_EQ(summary.subjects[1].levels.back().samplesPerPixel, 4u); // a line needs three
}

TEST_F(Studies, GoOnWhereTheyWereInterrupted) {
  unsigned calls = 0, limit = 13;
  Subject subject = noisy("strict", 0.2, 1, &calls);
  Subject cutOff = subject;
  cutOff.render = [&](std::uint32_t samples, std::uint32_t seed) {
    if (calls == limit)
      throw Error({ErrorCode::Cancelled, "interrupted"});
    return subject.render(samples, seed);
  };
  EXPECT_THROW(runStudy({cutOff}, reference, options), Error);
  // As if the line after the last had been cut off while it was written.
  const std::string table = readFile((folder / "measurements.csv").string());
  writeFileAtomically((folder / "measurements.csv").string(), table + "strict,2,5,1");

  const Summary resumed = study({subject});
  const std::size_t measured = readMeasurements((folder / "measurements.csv").string()).size();
  EXPECT_EQ(calls, measured + 2)
      << "each of both began with one picture that does not count, and none was rendered twice";
  EXPECT_EQ(resumed.subjects[0].levels.size() * options.runs, measured);

  calls = 0;
  study({subject});
  EXPECT_EQ(calls, 0u) << "a finished study renders nothing";

  fs::remove_all(folder);
  fs::create_directories(folder);
  const Summary whole = study({subject});
  EXPECT_EQ(calls, measured + 1);
  ASSERT_EQ(whole.subjects[0].levels.size(), resumed.subjects[0].levels.size());
  for (std::size_t i = 0; i < whole.subjects[0].levels.size(); ++i) {
    EXPECT_EQ(whole.subjects[0].levels[i].relMse.value, resumed.subjects[0].levels[i].relMse.value);
    EXPECT_DOUBLE_EQ(whole.subjects[0].levels[i].variance, resumed.subjects[0].levels[i].variance);
  }
}

TEST_F(Studies, GoOnAfterAnInterruptionInALaterRound) {
  unsigned calls = 0;
  const Subject subject = noisy("strict", 0.2, 1, &calls);
  options.budgetSeconds = 0.2; // four levels
  Subject cutOff = subject;
  cutOff.render = [&](std::uint32_t samples, std::uint32_t seed) {
    if (calls == 1 + 4 * 3 + 2) // in the fourth round
      throw Error({ErrorCode::Cancelled, "interrupted"});
    return subject.render(samples, seed);
  };
  EXPECT_THROW(runStudy({cutOff}, reference, options), Error);
  const Summary resumed = study({subject});
  EXPECT_EQ(calls, 2 + 4 * options.runs);
  EXPECT_FALSE(fs::exists(folder / "partial"));
  fs::remove_all(folder);
  fs::create_directories(folder);
  EXPECT_DOUBLE_EQ(study({subject}).subjects[0].levels.back().variance,
                   resumed.subjects[0].levels.back().variance);
}

TEST_F(Studies, MeasureInRounds) {
  options.budgetSeconds = 0.2;
  study({noisy("a", 0.2), noisy("b", 0.2)});
  const std::vector<Measurement> rows = readMeasurements((folder / "measurements.csv").string());
  ASSERT_EQ(rows.size(), 2 * 4 * 8u);
  std::set<std::vector<std::uint32_t>> orders;
  for (std::uint32_t round = 0; round < 8; ++round) {
    std::vector<std::uint32_t> order;
    std::set<std::pair<std::string, std::uint32_t>> pictures;
    for (std::size_t i = round * 8; i < (round + 1) * 8; ++i) {
      EXPECT_EQ(rows[i].run, round);
      pictures.insert({rows[i].configuration, rows[i].samplesPerPixel});
      if (i % 2 == 0)
        order.push_back(rows[i].samplesPerPixel);
      else
        EXPECT_EQ(rows[i].samplesPerPixel, rows[i - 1].samplesPerPixel)
            << "configurations are neighbours";
    }
    EXPECT_EQ(pictures.size(), 8u) << "a round has everything once";
    orders.insert(order);
  }
  EXPECT_GE(orders.size(), 5u) << "the rounds have orders of their own";
}

TEST_F(Studies, ReadTimesOffTheMeasuredPoints) {
  // Starting a picture takes as long as 40 samples, so that the curve is steep and then as it
  // should be. A line would be off by a factor.
  Subject subject = noisy("bent", 0.2);
  subject.render = [render = subject.render](std::uint32_t samples, std::uint32_t seed) {
    Picture picture = render(samples, seed);
    picture.statistics.renderSeconds = secondsPerSample * (samples + 40.0);
    return picture;
  };
  options.budgetSeconds = 3;
  Subject slow =
      noisy("slow", 0.2, 8); // has fewer levels: where it ends is the error that both came down to
  const Summary summary = study({subject, slow});
  const SubjectSummary &bent = summary.subjects[0];
  EXPECT_TRUE(bent.relMseOverSeconds.bends());
  EXPECT_FALSE(bent.relMseOverSamples.bends());
  ASSERT_TRUE(bent.lastSlopeOverSeconds);
  EXPECT_GT(bent.lastSlopeOverSeconds->value, bent.relMseOverSeconds.slope.value) << "it flattens";
  EXPECT_FALSE(summary.subjects[1].relMseOverSeconds.bends());
  EXPECT_NE(problems(summary).find("relMSE over seconds does not follow a straight line (bent;"),
            std::string::npos)
      << problems(summary);

  ASSERT_GT(bent.levels.size(), summary.subjects[1].levels.size());
  const std::uint32_t last = summary.subjects[1].levels.back().samplesPerPixel;
  ASSERT_TRUE(bent.toCommonRelMse);
  EXPECT_NEAR(bent.toCommonRelMse->seconds.value, secondsPerSample * (last + 40),
              1e-3 * secondsPerSample);
}

TEST_F(Studies, ReportThatThereIsNoVariance) {
  const Summary summary = study({noisy("constant", 0)});
  EXPECT_EQ(summary.subjects[0].relMseOverSeconds.points, 0u);
  EXPECT_NE(problems(summary).find("zero variance"), std::string::npos);
  EXPECT_NE(problems(summary).find("every picture equals the reference"), std::string::npos);
}

TEST_F(Studies, CountWhatIsNotFinite) {
  Subject subject = noisy("broken", 0.2);
  subject.render = [render = subject.render](std::uint32_t samples, std::uint32_t seed) {
    Picture picture = render(samples, seed);
    picture.image.pixels[0] = std::numeric_limits<float>::quiet_NaN();
    picture.image.pixels[3] = std::numeric_limits<float>::infinity();
    picture.statistics.samplesNotFinite = 2;
    return picture;
  };
  const Summary summary = study({subject});
  std::size_t pictures = 0;
  for (const LevelSummary &level : summary.subjects[0].levels)
    pictures += level.runs;
  EXPECT_EQ(summary.subjects[0].nanPixels, pictures);
  EXPECT_EQ(summary.subjects[0].infinitePixels, pictures);
  EXPECT_EQ(summary.subjects[0].samplesNotFinite, 2 * pictures);
  EXPECT_NEAR(summary.subjects[0].relMseOverSamples.slope.value, -1, 0.05)
      << "the other pixels still count";
}

TEST(RunningVariances, LeaveOutWhatIsNotFinite) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  RunningVariance spread;
  for (const std::array<float, 3> &values :
       {std::array<float, 3>{1, nan, nan}, {3, 5, nan}, {nan, 7, nan}}) {
    Image picture(1, 1, 3);
    picture.pixels.assign(values.begin(), values.end());
    spread.add(picture);
  }
  const Image mean = spread.mean();
  EXPECT_EQ(mean.pixels[0], 2.0f);
  EXPECT_EQ(mean.pixels[1], 6.0f);
  EXPECT_TRUE(std::isnan(mean.pixels[2]));
  EXPECT_DOUBLE_EQ(spread.meanVariance(), 2); // of the values that two pictures have
  EXPECT_DOUBLE_EQ(spread.meanRelativeVariance(0), (2.0 / 4 + 2.0 / 36) / 2);
}

TEST_F(Studies, MeasureTimesWithoutAUsableReference) {
  for (float value : reference.image.pixels)
    ASSERT_TRUE(std::isfinite(value));
  Image broken(width, height, 3);
  for (float &value : broken.pixels)
    value = std::numeric_limits<float>::quiet_NaN();
  const std::string path = (folder / "nan.exr").string();
  runtime::writeImage(path, broken);
  reference = readReference(path, width, height, 3);
  EXPECT_NE(reference.problem.find("no finite pixel"), std::string::npos);
  const Summary summary = study({noisy("strict", 0.2)});
  EXPECT_NE(problems(summary).find("no finite pixel"), std::string::npos);
  EXPECT_GT(summary.subjects[0].levels.size(), 3u);
  EXPECT_TRUE(std::isnan(summary.subjects[0].levels[0].relMse.value));
  EXPECT_GT(summary.subjects[0].levels[0].seconds.value, 0);
  EXPECT_NE(writePage({}, summary, reference, {}).find("no error above 0 was measured"),
            std::string::npos);

  EXPECT_NE(readReference(path, width + 1, height, 3).problem.find("25x16"), std::string::npos);
}

TEST_F(Studies, ReportThatTheReferenceIsBlack) {
  reference.image = Image(width, height, 3);
  EXPECT_NE(problems(study({noisy("strict", 0.2)})).find("the reference is black"),
            std::string::npos);
}

TEST_F(Studies, LeaveOutWhatTheReferenceCannotTell) {
  reference.ownError = Reference::OwnError();
  reference.ownError->relMse = 3e-3;
  const Summary summary = study({noisy("strict", 0.2)});
  EXPECT_FALSE(summary.subjects[0].levels.back().isResolved);
  EXPECT_TRUE(summary.subjects[0].levels.front().isResolved);
  EXPECT_NE(problems(summary).find("larger `--budget`"), std::string::npos);
}

TEST_F(Studies, ReportOnceWhatIsTrueOfAll) {
  const Summary both = study({noisy("first", 0), noisy("second", 0)});
  EXPECT_NE(problems(both).find("all configurations: all runs gave the same picture"),
            std::string::npos)
      << problems(both);
  fs::remove_all(folder);
  const Summary some = study({noisy("first", 0), noisy("second", 0), noisy("third", 0.2)});
  EXPECT_NE(problems(some).find("first, second: all runs gave the same picture"), std::string::npos)
      << problems(some);
}

TEST_F(Studies, MakeAReferenceWithItsOwnError) {
  Subject single = noisy("single", 0.2);
  single.render = [exact = single.render](std::uint32_t samples, std::uint32_t seed) {
    Picture picture = exact(samples, seed);
    for (float &value : picture.image.pixels)
      value += 1e-3f;
    return picture;
  };
  const Reference made = makeReference(noisy("double", 0.2), single, folder.string(), 8, 0.8,
                                       [](double, const std::string &) {});
  ASSERT_TRUE(made.ownError);
  EXPECT_NEAR(made.ownError->rounding, 1e-3, 1e-6);
  const double expected = 0.2 / std::sqrt(double(made.ownError->samplesPerPixel) * 8);
  EXPECT_NEAR(made.ownError->rmse / expected, 1, 0.1);
  double squares = 0;
  for (std::size_t i = 0; i < made.image.pixels.size(); ++i)
    squares += std::pow(double(made.image.pixels[i]) - truth().pixels[i], 2);
  EXPECT_NEAR(std::sqrt(squares / double(made.image.pixels.size())) / made.ownError->rmse, 1, 0.15)
      << "it is as wrong as it says";

  const std::optional<Reference> again = findReference("double", folder.string());
  ASSERT_TRUE(again);
  EXPECT_EQ(again->image.pixels, made.image.pixels);
  EXPECT_EQ(again->origin, made.origin);
  EXPECT_FALSE(findReference("strict", folder.string())) << "that one has another subject";
}

TEST_F(Studies, RefuseATableOfAnotherKind) {
  writeFileAtomically((folder / "measurements.csv").string(), "some,other,table\n1,2,3\n");
  EXPECT_THROW(study({noisy("strict", 0.2)}), Error);
}

TEST_F(Studies, PagesAreWholeAndAlone) {
  Context context;
  context.scene = "<scene> & \"more\"";
  const Summary summary = study({noisy("fast", 0.2), noisy("slow", 0.2, 3)});
  const std::string page = writePage(context, summary, reference, {{"a picture", truth()}});
  EXPECT_NE(page.find("&lt;scene&gt; &amp; &quot;more&quot;"), std::string::npos);
  for (const char *foreign : {"http://", "https://", "<script", "src=\"/", "@import"})
    EXPECT_EQ(page.find(foreign), std::string::npos) << foreign;
  for (const char *tag :
       {"svg", "table", "tr", "td", "figure", "g", "ul", "li", "details", "div"}) {
    const auto count = [&](const std::string &text) {
      std::size_t found = 0;
      for (std::size_t place = page.find(text); place != std::string::npos;
           place = page.find(text, place + 1))
        ++found;
      return found;
    };
    EXPECT_EQ(count("<" + std::string(tag) + ">") + count("<" + std::string(tag) + " "),
              count("</" + std::string(tag) + ">"))
        << tag;
  }
  EXPECT_EQ(page.find("nan"), std::string::npos) << "no coordinate is off the paper";
  // Each figure of a plot can be reached without a pointer.
  const auto count = [&](const std::string &text) {
    std::size_t found = 0;
    for (std::size_t place = page.find(text); place != std::string::npos;
         place = page.find(text, place + 1))
      ++found;
    return found;
  };
  const std::size_t levels = summary.subjects[0].levels.size() + summary.subjects[1].levels.size();
  EXPECT_EQ(count("<g class=\"point\" tabindex=\"0\""),
            4 * levels + summary.subjects[1].levels.size());
  EXPECT_EQ(count("class=\"tip\""), count("<g class=\"point\""));
  EXPECT_EQ(count("<title>"), 1u) << "of the page";
  EXPECT_EQ(count("type=\"checkbox\""), 2u);
}
