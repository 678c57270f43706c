// The conformance suites: what the plugins of each kind must hold to, without a test framework.
//
//   using namespace millscope::conformance;
//   const Descriptor& law = open_plugin("build/lib/libmy_law.so", "my_law");
//   ValueSet values(law);
//   values.set("static_friction", 0.3);
//   for (const Violation& v : check_contact_law(law, values.view())) …
//
// A test that needs one kind only compiles faster with that kind's header and open.hpp.
#pragma once

#include "millscope/conformance/analyzer.hpp"
#include "millscope/conformance/body_force.hpp"
#include "millscope/conformance/contact_law.hpp"
#include "millscope/conformance/geometry.hpp"
#include "millscope/conformance/interaction.hpp"
#include "millscope/conformance/observation.hpp"
#include "millscope/conformance/open.hpp"
#include "millscope/conformance/pair_parameter.hpp"
#include "millscope/conformance/wear_law.hpp"
