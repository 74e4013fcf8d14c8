/** Offers tasks that run the compiler, with its problem matcher. */

import * as vscode from "vscode";
import { type Command, findCommand } from "./command";

/** What a task in tasks.json says: `args` are those of `linkforge`. */
interface Definition extends vscode.TaskDefinition {
  args: string[];
}

export class Tasks implements vscode.TaskProvider {
  async provideTasks(): Promise<vscode.Task[]> {
    const command = await findCommand();
    const folders = command ? (vscode.workspace.workspaceFolders ?? []) : [];
    const offered = [["check"], ["check", "--watch"]];
    return folders.flatMap((folder) =>
      offered.map((args) => makeTask(command!, { type: "linkforge", args }, folder)),
    );
  }

  async resolveTask(task: vscode.Task): Promise<vscode.Task | undefined> {
    const command = await findCommand();
    return command && makeTask(command, task.definition as Definition, task.scope ?? vscode.TaskScope.Workspace);
  }
}

type Scope = vscode.WorkspaceFolder | vscode.TaskScope.Global | vscode.TaskScope.Workspace;

function makeTask([program, ...first]: Command, definition: Definition, scope: Scope): vscode.Task {
  const execution = new vscode.ProcessExecution(program, [...first, ...definition.args]);
  const isWatching = definition.args.includes("--watch") || definition.args[0] === "watch";
  const matcher = isWatching ? "$linkforge-watch" : "$linkforge";
  const task = new vscode.Task(definition, scope, definition.args.join(" "), "linkforge", execution, matcher);
  task.isBackground = isWatching;
  task.group = vscode.TaskGroup.Build;
  return task;
}
