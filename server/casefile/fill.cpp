// SPDX-License-Identifier: GPL-3.0-or-later
//
// Reads values of plain types into the messages, by the table of keys.
#include "casefile/sections.hpp"
#include "words/duration.hpp"

namespace anticrack::casefile {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

/// A field of a message.
struct Place {
  Message* message;
  const FieldDescriptor* field;

  const google::protobuf::Reflection& reflection() const { return *message->GetReflection(); }
  Message& below() const { return *reflection().MutableMessage(message, field); }
};

Place place_of(Message& message, std::string_view path) {
  const std::size_t dot = path.find('.');
  const Place place{&message,
                    message.GetDescriptor()->FindFieldByName(std::string(path.substr(0, dot)))};
  return dot == std::string_view::npos ? place : place_of(place.below(), path.substr(dot + 1));
}

void set_number(const Place& place, double value) {
  place.reflection().SetDouble(place.message, place.field, value);
}

void set_text(const Place& place, const std::string& value) {
  place.reflection().SetString(place.message, place.field, value);
}

void set_count(const Place& place, std::int32_t value) {
  if (place.field->cpp_type() == FieldDescriptor::CPPTYPE_UINT64)
    place.reflection().SetUInt64(place.message, place.field, static_cast<std::uint64_t>(value));
  else
    place.reflection().SetInt32(place.message, place.field, value);
}

void set_choice(const Place& place, std::size_t index) {
  int skipped = 0;  // number of the value to leave out
  while (place.field->enum_type()->value(skipped)->number() != 0) ++skipped;
  const int value = static_cast<int>(index);
  place.reflection().SetEnum(place.message, place.field,
                             place.field->enum_type()->value(value < skipped ? value : value + 1));
}

void set_time(const Section& section, const std::string& key, Message& to) {
  const toml::node& node = *section.find(key);
  const std::string text = node.value_exact<std::string>().value_or(shown(node));
  const auto time =
      node.is_string() || node.is_number() ? words::parse_duration(text) : std::nullopt;
  if (!time) {
    throw Error(section.spot_of(key), shown(node) +
                                          " is not a time above 0; write seconds, or \"90s\", "
                                          "\"10min\", \"2h\", \"1d\"");
  }
  google::protobuf::Duration duration;
  duration.set_seconds(time->count() / 1000);
  duration.set_nanos(static_cast<std::int32_t>(time->count() % 1000 * 1'000'000));
  to.CopyFrom(duration);
}

void fill_list(const Section& section, const Key& key, const Place& place, const std::string& field,
               Spots& spots) {
  int index = 0;
  for (const Section& entry : section.sections(key.name)) {
    fill(entry, *place.reflection().AddMessage(place.message, place.field),
         entry_field(field, index++), spots);
  }
}

/// Reads the value of a key that is present.
void read(const Section& section, const Key& key, Message& message, const std::string& field,
          Spots& spots) {
  const std::string name(key.name);
  if (key.type == Type::structure) return;
  const Place place = place_of(message, key.path());
  switch (key.type) {
    case Type::text:
      return set_text(place, *section.text(name));
    case Type::expression:
      return set_text(place, *section.expression(name));
    case Type::number:
      return set_number(place, *section.number(name));
    case Type::positive:
      return set_number(place,
                        positive_of(*section.find(name), section.path_of(name),
                                    !key.if_absent.starts_with("needed") && key.need.empty()));
    case Type::count:
      return set_count(place, *section.count(name));
    case Type::boolean:
      return place.reflection().SetBool(place.message, place.field, *section.boolean(name));
    case Type::choice:
      return set_choice(place, *section.choice(name, choices(*place.field->enum_type())));
    case Type::time:
      return set_time(section, name, place.below());
    case Type::point:
      return set(static_cast<v1::Point&>(place.below()),
                 point_of(*section.find(name), section.path_of(name)));
    case Type::table:
      return fill(*section.section(name), place.below(), field, spots);
    case Type::list:
      return fill_list(section, key, place, field, spots);
    case Type::structure:
    case Type::refused:
      break;
  }
}

}  // namespace

void note(const Section& section, const std::string& field, Spots& spots) {
  if (!field.empty()) spots[field] = section.spot();
  for (const auto& [key, node] : section.table()) {
    const Key& row = *section.keys().find(key.str());
    if (row.field == ".") continue;
    const std::string name(row.path());
    spots[field.empty() ? name : field + "." + name] = section.spot_of(key.str());
  }
}

void fill(const Section& section, Message& message, const std::string& field, Spots& spots) {
  note(section, field, spots);
  for (const Key* key : section.keys().known()) {
    if (!section.find(key->name)) {
      if (!key->need.empty()) section.need(key->name);
    } else if (key->field == ".") {
      fill(*section.section(key->name), message, field, spots);
    } else {
      read(section, *key, message, (field.empty() ? "" : field + ".") + std::string(key->path()),
           spots);
    }
  }
}

}  // namespace anticrack::casefile
