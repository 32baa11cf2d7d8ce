// SPDX-License-Identifier: Apache-2.0
//
// Tables of regions in a file: a line of text that identifies their floor and options, their
// number, then for each table its key and its words as they are in memory.
#include <filesystem>
#include <fstream>
#include <istream>
#include <ostream>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include "core/floor/distance_tables.h"

namespace fleet {
namespace {

/// A hash by FNV-1a (Fowler, Noll, Vo).
class Hash {
 public:
  template <typename Value>
  void add(const std::vector<Value>& values) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
    for (std::size_t i = 0; i < values.size() * sizeof(Value); ++i) {
      value_ = (value_ ^ bytes[i]) * 0x100000001b3;
    }
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325;
};

/// Returns a hash of all that tables depend on, except traffic.
std::uint64_t fingerprint(const Floor& floor) {
  Hash hash;
  hash.add(floor.edges(Deck::kUnder));
  hash.add(floor.edges(Deck::kAisles));
  std::vector<std::uint8_t> lanes(floor.size());
  for (Cell cell = 0; cell < floor.size(); ++cell) lanes[cell] = floor.isLane(cell);
  hash.add(lanes);
  return hash.value();
}

template <typename Value>
void put(std::ostream& out, const Value* values, std::size_t count) {
  out.write(reinterpret_cast<const char*>(values), count * sizeof(Value));
}

template <typename Value>
void get(std::istream& in, Value* values, std::size_t count) {
  in.read(reinterpret_cast<char*>(values), count * sizeof(Value));
  if (!in) throw std::runtime_error("the file ends before its last table");
}

}  // namespace

std::string DistanceTables::heading() const {
  constexpr int kVersion = 2;
  std::ostringstream text;
  text << "distance tables, version " << kVersion << ": " << floor_.width() << " x "
       << floor_.height() << " cells, floor " << std::hex << fingerprint(floor_) << std::dec
       << ", a quarter turn costs " << options_.turn_ticks << ", regions of "
       << (regions_ == nullptr ? 0 : regions_->side());
  return text.str();
}

void DistanceTables::save(std::ostream& out) const {
  std::vector<const Entry*> far;
  for (const Entry& entry : tables_) {
    if (entry.kind == Kind::kFar && entry.is_made) far.push_back(&entry);
  }
  out << heading() << '\n';
  const auto count = static_cast<std::uint64_t>(far.size());
  put(out, &count, 1);
  for (const Entry* entry : far) {
    put(out, &entry->key, 1);
    put(out, entry->table.words_.data(), entry->table.words_.size());
  }
}

void DistanceTables::load(std::istream& in) {
  std::string text;
  std::getline(in, text);
  if (text != heading()) {
    throw std::runtime_error("'" + text.substr(0, 100) + "'; '" + heading() + "' was expected");
  }
  std::uint64_t count = 0;
  get(in, &count, 1);
  for (std::uint64_t i = 0; i < count; ++i) {
    std::int64_t key = 0;
    get(in, &key, 1);
    const auto goal = static_cast<Cell>(key >> 2);
    const auto deck = static_cast<Deck>(key >> 1 & 1);
    const bool is_middle = regions_ != nullptr && key >= 0 && key >> 2 < floor_.size() &&
                           (key & 1) != 0 && regions_->middle(deck, regions_->of(goal)) == goal;
    if (!is_middle) {
      throw std::runtime_error("table " + std::to_string(i) + " has the key " +
                               std::to_string(key) + "; that of a region was expected");
    }
    has_worked_ = false;
    Entry* entry = known(key) != nullptr ? known(key) : create(Kind::kFar, deck, goal);
    if (entry == nullptr) return;  // no room for more
    entry->table.words_.resize(cells(Kind::kFar, goal));
    if (numbers_ != nullptr) entry->table.numbers_ = numbers_->of_cell.data();
    get(in, entry->table.words_.data(), entry->table.words_.size());
    entry->is_made = true;
  }
}

void DistanceTables::save(const std::string& path) const {
  std::ofstream file(path, std::ios::binary);
  if (file) save(file);
  file.close();
  if (!file) throw std::runtime_error(path + ": the tables could not be written");
}

void DistanceTables::load(const std::string& path) {
  std::error_code failed;  // a device or a pipe might never end
  std::ifstream file;
  if (std::filesystem::is_regular_file(path, failed)) file.open(path, std::ios::binary);
  if (!file.is_open()) throw std::runtime_error(path + ": no such file, or it can't be read");
  try {
    load(file);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
}

}  // namespace fleet
