// The program's commands: each takes the arguments after its name and answers with the exit status.
#pragma once

#include <string>
#include <vector>

namespace ukemi {

using Arguments = std::vector<std::string>;

int bake_command(const Arguments& arguments);
int batch_command(const Arguments& arguments);
int recipe_command(const Arguments& arguments);
int inspect_command(const Arguments& arguments);
int judge_command(const Arguments& arguments);
int render_command(const Arguments& arguments);
int compare_command(const Arguments& arguments);
int diff_command(const Arguments& arguments);
int rom_command(const Arguments& arguments);
int calibrate_command(const Arguments& arguments);
int review_command(const Arguments& arguments);
int help_command(const Arguments& arguments);

std::vector<std::string> command_names();

/// The whole command line without the program's name.
int run(const Arguments& arguments);

}  // namespace ukemi
