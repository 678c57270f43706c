// The conformance suite: what every contact law and every interaction must hold to, without a test framework.
//
//   using namespace millscope::conformance;
//   const Descriptor& law = open_plugin("build/lib/libmy_law.so", "my_law");
//   ValueSet values(law);
//   values.set("static_friction", 0.3);
//   for (const Violation& v : check_contact_law(law, values.view())) …
#pragma once

#include "millscope/conformance/contact_law.hpp"
#include "millscope/conformance/interaction.hpp"
#include "millscope/conformance/open.hpp"
#include "millscope/conformance/values.hpp"
