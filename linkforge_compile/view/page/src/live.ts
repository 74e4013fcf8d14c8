/** Updates from the server of `linkforge view`, and settings sent to it. Addresses are relative to the page's. */
import type { State, Update } from "./state";

/** What the user changed: a text or null, the default, for each parameter, and the variant if that was changed. */
interface SettingsRequest {
  parameters: Record<string, string | null>;
  variant?: string | null;
}

/** Show each update of the server, and whether the server can be reached. */
export function listen(state: State): void {
  const events = new EventSource(`events?version=${state.scene.version ?? 0}`); // which this page holds
  events.addEventListener("update", (event: MessageEvent<string>) => {
    state.reportConnection("");
    state.receive(JSON.parse(event.data) as Update);
  });
  events.addEventListener("open", () => state.reportConnection(""));
  events.addEventListener("error", () => state.reportConnection("connection lost; the server has stopped"));
}

/** Compile with other settings; the result arrives as an update. */
export async function sendSettings(state: State, request: SettingsRequest): Promise<void> {
  try {
    const answer = await fetch("settings", {
      method: "POST",
      headers: { "Content-Type": "application/json" },
      body: JSON.stringify(request),
    });
    if (!answer.ok) state.reportConnection(`the server refused the settings: ${answer.status} ${await answer.text()}`);
  } catch {
    state.reportConnection("connection lost; the server has stopped");
  }
}
