// Options of the commands that take a study.yaml and run simulations for it.
#pragma once

#include <filesystem>

#include "app/commands.hpp"
#include "studies/calibrate/session.hpp"

namespace millscope::app {

void add_study_options(Options& options);
/// Where simulations run and are kept, for commands without a study; `cache`: what the help says of it.
void add_runner_options(Options& options, const char* cache);
/// --draws of a diagnosis; 0: as many as its level asks for. Throws UserError where they are too few for any.
void add_draws_option(Options& options);
int draws_of(const Options& options);
/// A line on standard output, at once.
void print_line(const std::string& line);
/// "--partition=long --time=60" → words.
std::vector<std::string> words_of(const std::vector<std::string>& texts);
calibrate::SessionOptions study_session(const Options& options, const std::filesystem::path& output);

}  // namespace millscope::app
