// SPDX-License-Identifier: Apache-2.0
#include "kiva_plugin_cpp/parameters.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

namespace kiva {
namespace {

/// Returns the message of the DescriptionError that `call` throws.
std::string error(const std::function<void()>& call) {
  try {
    call();
  } catch (const DescriptionError& error) {
    return error.what();
  }
  return "no error";
}

Parameters motion() {
  Parameters parameters("model 'kiva', plugin 'motion'");
  parameters.set("speed", " 1.5\n");
  parameters.set("rays", "+121");
  parameters.set("drive", " traction ");
  parameters.set("pose/x", "-2e-1");
  return parameters;
}

TEST(Parameters, ReadsValuesAndTrimsBlanks) {
  const Parameters p = motion();
  EXPECT_EQ(p.number("speed", 0, 0, 10), 1.5);
  EXPECT_EQ(p.number("pose/x", 0, -1, 1), -0.2);
  EXPECT_EQ(p.whole("rays", 0, 1, 1000), 121);
  EXPECT_EQ(p.text("drive", ""), "traction");
}

TEST(Parameters, FallBackWhereNothingIsGiven) {
  const Parameters p;
  EXPECT_EQ(p.number("speed", 1.25, 0, 1), 1.25);
  EXPECT_EQ(p.whole("rays", 7, 0, 1), 7);
  EXPECT_EQ(p.text("drive", "jointed"), "jointed");
}

TEST(Parameters, RefuseWhatIsNoNumberOrOutOfRange) {
  const double inf = std::numeric_limits<double>::infinity();
  for (const char* bad : {"fast", "", "nan", "1.5 m/s", "-0.1", "10.1", "1,5"}) {
    Parameters p("model 'kiva', plugin 'motion'");
    p.set("speed", bad);
    EXPECT_EQ(error([&] { p.number("speed", 1, 0, 10); }),
              "model 'kiva', plugin 'motion': parameter 'speed' is '" + std::string(bad) +
                  "', expected a number from 0 to 10");
  }
  Parameters p;
  p.set("mass", "-1");
  EXPECT_EQ(error([&] { p.number("mass", 1, 0, inf); }),
            "parameter 'mass' is '-1', expected a number from 0 upwards");
}

TEST(Parameters, RefuseBrokenWholeNumbers) {
  for (const char* bad : {"1.5", "1e3", "0", "99999999999", "x"}) {
    Parameters p;
    p.set("rays", bad);
    EXPECT_EQ(
        error([&] { p.whole("rays", 1, 1, 1000); }),
        "parameter 'rays' is '" + std::string(bad) + "', expected a whole number from 1 to 1000");
  }
}

TEST(Parameters, AcceptTheEndsOfTheRange) {
  Parameters p;
  p.set("low", "0");
  p.set("high", "10");
  EXPECT_EQ(p.number("low", 1, 0, 10), 0);
  EXPECT_EQ(p.number("high", 1, 0, 10), 10);
}

TEST(Parameters, NameWhatNobodyReadAndWhatIsKnown) {
  const Parameters p = motion();
  EXPECT_EQ(error([&] { p.rejectUnread(); }),
            "model 'kiva', plugin 'motion': unknown parameter 'drive', 'pose/x', 'rays', 'speed'; "
            "it takes none");
  p.number("speed", 0, 0, 10);
  p.number("acceleration", 0, 0, 10);  // Asked for, though it was not given.
  p.whole("rays", 0, 0, 1000);
  p.text("drive", "");
  EXPECT_EQ(error([&] { p.rejectUnread(); }),
            "model 'kiva', plugin 'motion': unknown parameter 'pose/x'; it takes 'acceleration', "
            "'drive', 'rays', 'speed'");
  p.number("pose/x", 0, -1, 1);
  EXPECT_EQ(error([&] { p.rejectUnread(); }), "no error");
}

}  // namespace
}  // namespace kiva
