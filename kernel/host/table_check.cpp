#include "kernel/host/descriptor_check.hpp"
#include "millscope/analyzer.hpp"
#include "millscope/body_force.hpp"
#include "millscope/contact_law.hpp"
#include "millscope/geometry.hpp"
#include "millscope/interaction.hpp"
#include "millscope/observation.hpp"
#include "millscope/pair_parameter.hpp"
#include "millscope/wear_law.hpp"

namespace millscope::host {

namespace {

template <class... Functions>
std::string missing(Functions... functions) {
  return (... || (functions == nullptr)) ? "a function of its table is missing (null)" : "";
}

template <class Info>
std::string insane(const Info& info) {
  return is_sane(info) ? ""
                       : "its histories or channels are not sane: a null name, a sign that is not +1 or -1, an unknown role, or too many";
}

std::string either(const std::string& first, const std::string& second) { return first.empty() ? second : first; }

std::string check(const ContactLawTable& t, const Descriptor&) {
  return either(missing(t.create, t.destroy, t.reach, t.evaluate, t.evaluate_scalar, t.contact_time), insane(t.info));
}

std::string check(const InteractionTable& t, const Descriptor& d) {
  const std::uint64_t phase = d.features & (kPreInteraction | kPostInteraction);
  if (phase != kPreInteraction && phase != kPostInteraction) return "its features must hold one of kPreInteraction and kPostInteraction";
  return either(missing(t.create, t.destroy, t.reach, t.evaluate, t.evaluate_scalar), insane(t.info));
}

std::string check(const PairParameterTable& t, const Descriptor& d) {
  if ((d.features & (kGivesRestitution | kGivesFriction)) == 0) return "its features must hold kGivesRestitution or kGivesFriction";
  return either(missing(t.create, t.destroy, t.evaluate), insane(t.info));
}

std::string check(const BodyForceTable& t, const Descriptor&) { return missing(t.create, t.destroy, t.uniform, t.evaluate); }

std::string check(const GeometryTable& t, const Descriptor&) {
  return missing(t.create, t.destroy, t.material_slots, t.surface, t.interior, t.report, t.candidates, t.contacts);
}

std::string check(const ObservationTable& t, const Descriptor&) { return missing(t.create, t.destroy, t.observe); }

std::string check(const WearLawTable& t, const Descriptor&) { return missing(t.create, t.destroy, t.evaluate); }

std::string check(const AnalyzerTable& t, const Descriptor&) { return missing(t.create, t.destroy, t.arrays, t.accumulate, t.finish); }

template <class Table>
std::string check_as(const Descriptor& d) {
  return check(*static_cast<const Table*>(d.table), d);
}

}  // namespace

std::string table_complaint(const Descriptor& d) {
  switch (static_cast<Kind>(d.kind)) {
    case Kind::contact_law:
      return check_as<ContactLawTable>(d);
    case Kind::interaction:
      return check_as<InteractionTable>(d);
    case Kind::pair_parameter:
      return check_as<PairParameterTable>(d);
    case Kind::body_force:
      return check_as<BodyForceTable>(d);
    case Kind::geometry:
      return check_as<GeometryTable>(d);
    case Kind::observation:
      return check_as<ObservationTable>(d);
    case Kind::analyzer:
      return check_as<AnalyzerTable>(d);
    case Kind::wear_law:
      return check_as<WearLawTable>(d);
  }
  return "is of an unknown kind";
}

}  // namespace millscope::host
