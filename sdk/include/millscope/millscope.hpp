// Everything that a plugin author may want. A plugin of one kind compiles faster with that kind's adapter alone.
#pragma once

#include "millscope/abi.hpp"
#include "millscope/analyzer_adapter.hpp"
#include "millscope/body_force_adapter.hpp"
#include "millscope/contact_law_adapter.hpp"
#include "millscope/functions.hpp"
#include "millscope/geometry_adapter.hpp"
#include "millscope/interaction_adapter.hpp"
#include "millscope/observation_adapter.hpp"
#include "millscope/pack.hpp"
#include "millscope/pair_parameter_adapter.hpp"
#include "millscope/parameters.hpp"
#include "millscope/wear_law_adapter.hpp"
