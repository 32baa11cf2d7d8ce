// SPDX-License-Identifier: Apache-2.0
//
// Values of elements and attributes: numbers as C writes them, flags as true, false, 1, 0.
#pragma once

#include <optional>
#include <string>

#include "world_file/elements/format.h"
#include "world_file/files/xml.h"

namespace kiva {

/// Returns the fault of a text as a value of that format, in words, or "". `name` is the name of
/// its element or attribute.
std::string faultOfValue(const std::string& text, const std::string& name,
                         const ValueFormat& format);
/// Does the same for the text of a `<pose>` with its attributes.
std::string faultOfPoseText(const XmlElement& pose);

std::optional<double> readDouble(const std::string& text);
std::optional<bool> readFlag(const std::string& text);
std::optional<Vector3> readVector(const std::string& text);
std::optional<std::vector<double>> readColour(const std::string& text);  ///< Four of 0…1.

/// Returns the value of a child that the format knows and that was checked before, or `otherwise`.
double numberIn(const XmlElement& element, const char* child, double otherwise);
bool flagIn(const XmlElement& element, const char* child, bool otherwise);
Vector3 vectorIn(const XmlElement& element, const char* child, const Vector3& otherwise);
Vector3 vectorIn(const XmlElement& element);
/// Returns the pose of a `<pose>`; zero for null.
Pose valueOfPose(const XmlElement* pose);

}  // namespace kiva
