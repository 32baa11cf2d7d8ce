// SPDX-License-Identifier: Apache-2.0
//
// Texts of elements and attributes as values: numbers as C writes them, flags as true, false, 1, 0.
#pragma once

#include <optional>
#include <string>

#include "world_file/elements/format.h"
#include "world_file/files/xml.h"

namespace kiva {

/// What is wrong with a text as a value of that format, for a person; empty: nothing. `name` is the
/// element's or the attribute's.
std::string faultOfValue(const std::string& text, const std::string& name,
                         const ValueFormat& format);
/// The same for the text of a `<pose>` with its attributes.
std::string faultOfPoseText(const XmlElement& pose);

std::optional<double> readDouble(const std::string& text);
std::optional<bool> readFlag(const std::string& text);
std::optional<Vector3> readVector(const std::string& text);
std::optional<std::vector<double>> readColour(const std::string& text);  ///< Four of 0…1.

/// Of a child that the format knows, checked before: what it holds, or `otherwise`.
double numberIn(const XmlElement& element, const char* child, double otherwise);
bool flagIn(const XmlElement& element, const char* child, bool otherwise);
Vector3 vectorIn(const XmlElement& element, const char* child, const Vector3& otherwise);
Vector3 vectorIn(const XmlElement& element);
/// Of a `<pose>`; zero for null.
Pose valueOfPose(const XmlElement* pose);

}  // namespace kiva
